// SPDX-License-Identifier: GPL-3.0-or-later
// What formulas saw along recordings, and the recordings in which something is lost.
#include "gap/equation/visited.h"

#include "core/rig.h"
#include "gap/equation/kinds_left_out.h"
#include "gap/equation/losing.h"
#include "gap/fit/score.h"
#include "plant/effects/catalogue.h"
#include "plant/formulas/formula_effect.h"
#include "tests/gap/simulated_campaign.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo::gap {
namespace {

FormulaEffect effect_text(const std::string& acts_on, const std::string& block, const std::string& text) {
    FormulaEffect effect;
    effect.name = "of_test";
    effect.acts_on = acts_on;
    effect.block = block;
    effect.formula = "size * " + text;
    effect.parameters.push_back({.name = "size", .low = -10.0, .high = 10.0, .typical = 1.0});
    return effect;
}

TEST(VisitedVariables, OfTheCarriage_AreThoseOfTheRecording) {
    const Evidence evidence = testing::campaign({}, {"macro-sweep"});
    const std::vector<SeenVariables> seen = variables_along(evidence, plant::Site::carriage, 0);
    const std::vector<StageRow>& rows = evidence.recordings()[0].rows;
    ASSERT_EQ(seen.size(), rows.size());
    using namespace plant::carriage_variable;
    double way_mm = 0.0;
    for (std::size_t k = 0; k < seen.size(); ++k) {
        ASSERT_EQ(seen[k][command], rows[k].macro_command_V);
        ASSERT_NEAR(seen[k][time], 0.001 * static_cast<double>(k), 1e-9);
        ASSERT_NEAR(seen[k][way], way_mm, 1e-6);
        way_mm += 0.001 * std::abs(seen[k][speed]);
    }
    EXPECT_GT(way_mm, 100.0) << "it has moved";
}

TEST(VisitedVariables, FormulaThatRemembers_GoesOnRowByRow) {
    const Evidence evidence = testing::campaign({}, {"macro-sweep"});
    FormulaEffect late = effect_text("macro.drive_voltage", "macro.drive", "kept");
    late.memories.push_back(
        {.name = "kept", .kind = FormulaEffect::Memory::Kind::delay, .of = "command", .by = "0.005"});
    FormulaEffect slow = effect_text("macro.drive_voltage", "macro.drive", "kept");
    slow.memories.push_back({.name = "kept",
                             .kind = FormulaEffect::Memory::Kind::state,
                             .of = "(command - kept) / 0.02",
                             .by = {}});
    const std::vector<double> one{1.0};
    const auto delayed = values_along(evidence, plant::FormulaCode::of(late), one, 0),
               lagging = values_along(evidence, plant::FormulaCode::of(slow), one, 0);
    const std::vector<StageRow>& rows = evidence.recordings()[0].rows;
    ASSERT_EQ(delayed.size(), rows.size());
    double filtered_V = rows.front().macro_command_V;
    for (std::size_t k = 5; k < rows.size(); ++k)
        ASSERT_NEAR(delayed[k], rows[k - 5].macro_command_V, 1e-9) << k;
    for (std::size_t k = 0; k < rows.size(); ++k) {
        ASSERT_NEAR(lagging[k], filtered_V, 1e-6) << k;
        filtered_V += (rows[k].macro_command_V - filtered_V) * -std::expm1(-0.001 / 0.02);
    }
}

TEST(WhereMostIsLost, OfUnequalRecordings_TakesThoseThatHoldTheShare) {
    const Evidence evidence = testing::campaign({}, {"macro-pulses", "macro-sweep", "macro-square"});
    std::vector<double> squares;
    for (const Window& window : evidence.windows()) squares.push_back(window.run == 1 ? 1e6 : 1.0);
    const auto runs = [&](const Wanted& wanted) {
        std::set<std::size_t> found;
        for (std::size_t w = 0; w < wanted.size(); ++w) {
            if (wanted[w] == 0) continue;
            EXPECT_EQ(evidence.windows()[w].signal, Signal::encoder);
            found.insert(evidence.windows()[w].run);
        }
        return found;
    };
    EXPECT_EQ(runs(where_most_is_lost(evidence, Signal::encoder, squares, 0.5, 0, 9)),
              (std::set<std::size_t>{1}));
    EXPECT_EQ(runs(where_most_is_lost(evidence, Signal::encoder, squares, 0.5, 4, 9)).size(), 4U);
    EXPECT_EQ(runs(where_most_is_lost(evidence, Signal::encoder, squares, 1.0, 0, 2)).size(), 2U);
    EXPECT_EQ(runs(where_most_is_lost(evidence, Signal::encoder, squares, 1.0, 0, 9)).size(), 6U);
}

/// A law also holds for experiments to which it was not fitted; a function that only fits does not.
TEST(KindsLeftOut, DragAndABellInItsPlace_AreToldApart) {
    const plant::Effect& drag =
        plant::effect_of(effect_text("macro.friction", "macro.friction", "4e-6 * speed * abs(speed)"));
    const Evidence evidence =
        testing::campaign({plant::typical_setting(drag)}, {"macro-pulses", "macro-sweep"});
    const auto judged = [&](const plant::Effect& effect) {
        CrossFit cross;
        cross.of_half = {Hypothesis{plant::typical_setting(effect)},
                         Hypothesis{plant::typical_setting(effect)}};
        cross.mean_squares =
            mean_squares(evidence.windows(), evidence.errors(cross.of_half[0], everything(evidence)));
        return total_loss(predicted_from_other_kinds(evidence, cross));
    };
    const plant::Effect& bell = plant::effect_of(
        effect_text("macro.force", "macro.mechanics", "0.01 * exp(-((place - 100) / 30)^2)"));
    EXPECT_LT(judged(drag) + 20.0, judged(bell));
    const Evidence one_kind = testing::campaign({}, {"macro-pulses"});
    CrossFit cross;
    cross.of_half = {Hypothesis{plant::typical_setting(drag)}, Hypothesis{plant::typical_setting(drag)}};
    cross.mean_squares.assign(one_kind.windows().size(), 1.0);
    EXPECT_TRUE(predicted_from_other_kinds(one_kind, cross).empty());
}

}  // namespace
}  // namespace fidservo::gap
