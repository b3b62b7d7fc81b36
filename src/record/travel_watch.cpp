// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/record/travel_watch.h"

#include "core/rig.h"

#include <cmath>

namespace fidservo {

TravelWatch travel_watch(const Rig& rig) {
    constexpr double margin_mm = 0.5;
    return {rig.macro.low_mm + margin_mm, rig.macro.high_mm - margin_mm,
            -rig.tick_s / std::log(rig.macro.velocity_pole), rig.tick_s};
}

bool leaves_travel(const TravelWatch& watch, TravelWatchState& state, double carriage_mm) {
    constexpr double share = 0.1;
    const double speed_mm_per_s = (carriage_mm - state.last_mm.value_or(carriage_mm)) / watch.tick_s;
    state.speed_mm_per_s += share * (speed_mm_per_s - state.speed_mm_per_s);
    state.last_mm = carriage_mm;
    const double rest_mm = carriage_mm + state.speed_mm_per_s * watch.coast_s;
    return rest_mm < watch.low_mm || rest_mm > watch.high_mm;
}

}  // namespace fidservo
