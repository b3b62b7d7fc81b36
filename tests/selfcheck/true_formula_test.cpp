// SPDX-License-Identifier: GPL-3.0-or-later
// The formula against which equations are judged is that of the rig: with it the plant predicts the
// independent model's recordings to the floor.
#include "src/selfcheck/draw/true_formula.h"

#include "core/rig.h"
#include "gap/fit/gap_size.h"
#include "gap/fit/score.h"
#include "plant/effects/catalogue.h"
#include "plant/formulas/formula_effect.h"
#include "src/files/rig/rig_file.h"
#include "src/selfcheck/draw/campaign.h"
#include "src/selfcheck/draw/listed_effects.h"
#include "src/selfcheck/draw/put_effect.h"
#include "src/selfcheck/draw/unlisted_effects.h"

#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace fidservo::selfcheck {
namespace {

const Rig& file_rig() {
    static const Rig rig = load_rig(FIDSERVO_ASSETS_DIR "/rig.yaml");
    return rig;
}

/// R.m.s. over the signals, in floors.
double floors(const gap::Evidence& evidence, const gap::Hypothesis& hypothesis) {
    const gap::Wanted all = gap::everything(evidence);
    const std::vector<double> before = gap::mean_squares(evidence.windows(), evidence.errors({}, all));
    const std::vector<double> after = gap::mean_squares(evidence.windows(), evidence.errors(hypothesis, all));
    return gap::total_gap(gap::signal_gaps(evidence, before, after)).after;
}

struct Drawn {
    std::string effect, way;
    TrueRig rig;
};

/// The largest size of each effect, in each of its ways.
std::vector<Drawn> all_drawn() {
    std::vector<Drawn> all;
    for (const EffectDraw& way : listed_effects()) {
        TrueRig rig{file_rig(), {}};
        NoiseStream draw(7, fmt::format("{}/{}", way.effect, way.formula));
        way.put(rig.departures, way.largest, draw);
        all.push_back({std::string(way.effect), std::string(way.formula), rig});
    }
    for (const UnlistedEffect& effect : unlisted_effects()) {
        TrueRig rig{file_rig(), {}};
        NoiseStream draw(7, effect.name);
        effect.put(rig, effect.largest, draw);
        all.push_back({std::string(effect.name), "", rig});
    }
    return all;
}

TEST(TrueFormula, OfEveryEffect_IsThereOrItIsSaidWhyNot) {
    for (const Drawn& drawn : all_drawn())
        EXPECT_TRUE(as_formula(drawn.rig, file_rig(), drawn.effect) ||
                    !why_not_a_formula(drawn.effect).empty())
            << drawn.effect << " " << drawn.way;
}

TEST(SlowTrueFormula, OfTheIndependentModel_PredictsItToTheFloor) {
    int compared = 0;
    for (const Drawn& drawn : all_drawn()) {
        const auto text = as_formula(drawn.rig, file_rig(), drawn.effect);
        if (!text) continue;
        std::vector<Recording> recordings;
        recordings.push_back(record_run(file_rig(), drawn.rig, {"integrated", "integrated-1"}, 11));
        const gap::Evidence evidence(file_rig(), std::move(recordings));
        const double before = floors(evidence, {}),
                     after = floors(evidence, {plant::typical_setting(plant::effect_of(*text))});
        fmt::print("{} {}: {} = {}: {:.3g} -> {:.3g} floors\n", drawn.effect, drawn.way, text->acts_on,
                   text->formula, before, after);
        EXPECT_GT(before, gap::least_floors) << "it shows: " << drawn.effect << " " << drawn.way;
        EXPECT_LT(after, gap::least_floors) << drawn.effect << " " << drawn.way;
        ++compared;
    }
    EXPECT_GT(compared, 30);
}

}  // namespace
}  // namespace fidservo::selfcheck
