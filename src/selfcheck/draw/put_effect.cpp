// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/selfcheck/draw/put_effect.h"

#include "gap/candidates/candidate.h"
#include "plant/effects/catalogue.h"
#include "src/selfcheck/draw/rounds.h"

#include <algorithm>

namespace fidservo::selfcheck {

TrueEffect true_effect(const EffectDraw& way, double size) {
    return {.effect = std::string(way.effect),
            .class_name = std::string(gap::class_of(way.effect)),
            .block = std::string(plant::find_effect(way.effect)->block),
            .formula = std::string(way.formula),
            .size = size,
            .expected_floors = size / way.floor_size};
}

TrueEffect put_listed(TrueRig& rig, std::string_view class_name, NoiseStream& draw) {
    constexpr double smallest_floors = 0.7, smallest_share = 1.0 / 300.0;
    const std::vector<const EffectDraw*> ways = draws_of(class_name);
    const EffectDraw& way = *ways[index_below(draw, ways.size())];
    const double smallest = std::max(smallest_floors * way.floor_size, smallest_share * way.largest);
    const double size = log_uniform(draw, smallest, way.largest);
    way.put(rig.departures, size, draw);
    return true_effect(way, size);
}

}  // namespace fidservo::selfcheck
