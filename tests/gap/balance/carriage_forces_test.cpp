// SPDX-License-Identifier: GPL-3.0-or-later
// The forces that a carriage's prediction lacks, for known forces.
#include "gap/balance/carriage_forces.h"

#include "core/rig.h"
#include "gap/balance/patch_search.h"
#include "gap/balance/period_search.h"
#include "plant/effects/catalogue.h"
#include "tests/gap/simulated_campaign.h"

#include <cmath>
#include <map>
#include <numbers>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;
using testing::campaign;
using testing::effects;

constexpr std::size_t half_support = 25;

CarriageForces lacking_of_file(const Evidence& evidence) {
    return {evidence, evidence.errors({}, everything(evidence)), half_support};
}

/// The factor on a column of a unit quantity that fits the difference between the true rig and the file.
double fitted(const CarriageForces& forces, const Column& column) {
    double product = 0.0, square = 0.0;
    for (std::size_t support = 0; support < column.values.size(); ++support) {
        const double value = column.values[support];
        product -= value * static_cast<double>(forces.lacking()[support]);
        square += value * value;
    }
    return product / square;
}

double mean_square(const CarriageForces& forces) {
    double sum = 0.0;
    for (const double lacking : forces.lacking()) sum += std::pow(lacking, 2);
    return sum / static_cast<double>(forces.supports().size());
}

TEST(CarriageForces, RigAsItsFileSays_LacksNoMoreThanRoundingMakes) {
    const CarriageForces forces = lacking_of_file(campaign({}, {"macro-sweep", "macro-pulses"}));
    ASSERT_GT(forces.supports().size(), 500U);
    EXPECT_NEAR(mean_square(forces), 1.0, 0.3);
}

TEST(CarriageForces, ForceBesideTheCommand_ComesBackInVolts) {
    const CarriageForces forces =
        lacking_of_file(campaign(effects({"drive_offset:offset_V=0.02"}), {"macro-sweep", "macro-pulses"}));
    const double found_V = fitted(forces, forces.of_force(0, [](const SlidingRow& at) { return at.passed; }));
    EXPECT_NEAR(found_V, 0.02, 0.03 * 0.02);
}

TEST(CarriageForces, FrictionOnTheMotion_ComesBackInVolts_WhetherTheDrivePushesOrNot) {
    const double truth = 4e-4;
    const CarriageForces forces = lacking_of_file(
        campaign(effects({"viscous_friction:damping_V_s_per_mm=0.0004"}), {"macro-sweep", "macro-pulses"}));
    const double found =
        -fitted(forces, forces.of_force(0, [](const SlidingRow& at) { return at.velocity_mm_per_s; }));
    EXPECT_NEAR(found, truth, 0.03 * truth);
}

TEST(CarriageForces, Windows_HaveTheirSupportsOneAfterTheOther) {
    const Evidence evidence = campaign({}, {"macro-sweep", "micro-steps"});
    const CarriageForces forces = lacking_of_file(evidence);
    ASSERT_EQ(forces.windows().size(), evidence.windows().size());
    std::size_t next = 0;
    for (std::size_t w = 0; w < forces.windows().size(); ++w) {
        const Window &window = evidence.windows()[w], &of_supports = forces.windows()[w];
        EXPECT_EQ(of_supports.begin, next);
        next = of_supports.end;
        if (window.signal != Signal::encoder) {
            EXPECT_EQ(of_supports.begin, of_supports.end);
        }
        for (std::size_t support = of_supports.begin; support < of_supports.end; ++support) {
            const SlidingRow& first = forces.rows()[forces.supports()[support]];
            EXPECT_EQ(first.run, window.run);
            EXPECT_GE(first.row, window.first_row);
            EXPECT_LE(first.row + 2 * half_support, window.first_row + window.rows - 1);
        }
    }
    EXPECT_EQ(next, forces.supports().size());
}

TEST(CarriageForces, StateAtAWindowsStart_IsNoForce) {
    const Evidence evidence = campaign({}, {"macro-sweep"});
    const double decay = evidence.rig().macro.velocity_pole;
    Errors errors = evidence.errors({}, everything(evidence));
    const CarriageForces before(evidence, errors, half_support);
    for (const Window& window : evidence.windows()) {
        if (window.signal != Signal::encoder) continue;
        for (std::size_t k = 0; k < window.rows; ++k)
            errors[window.begin + k] +=
                static_cast<float>(20.0 + 100.0 * std::pow(decay, static_cast<double>(k)));
    }
    const CarriageForces after(evidence, errors, half_support);
    ASSERT_FALSE(after.supports().empty());
    const auto start_of = [](const CarriageForces& forces, std::size_t support) {
        const SlidingRow& row = forces.rows()[forces.supports()[support]];
        return std::pair(row.run, row.row);
    };
    std::map<std::pair<std::size_t, std::size_t>, double> known;
    for (std::size_t support = 0; support < before.supports().size(); ++support)
        known[start_of(before, support)] = before.lacking()[support];
    for (std::size_t support = 0; support < after.supports().size(); ++support)
        EXPECT_NEAR(after.lacking()[support], known.at(start_of(after, support)), 0.05);
}

/// As accurate as the start of a fit needs: a fifth of the amplitude, a tenth of a period over half the rail.
TEST(SlowPeriodSearch, ForceThatLetsTheCarriageGoByJumps_ComesBackWithPeriodAmplitudeAndPhase) {
    struct Truth {
        double amplitude_V, period_mm, phase_rad;
    };
    for (const Truth& truth : {Truth{0.1, 5.0, 1.0}, Truth{0.1, 2.2, -2.0}, Truth{0.02, 11.3, 0.5}}) {
        const Evidence evidence =
            campaign(effects({fmt::format("cogging:amplitude_V={},period_mm={},phase_rad={}",
                                          truth.amplitude_V, truth.period_mm, truth.phase_rad)}),
                     {"macro-sweep", "macro-pulses", "macro-square"});
        const auto periods = strongest_periods(evidence, evidence.errors({}, everything(evidence)));
        ASSERT_FALSE(periods.empty());
        const PositionPeriod& found = periods.front();
        EXPECT_NEAR(found.force_V.amplitude, truth.amplitude_V, 0.2 * truth.amplitude_V) << truth.period_mm;
        constexpr double middle_mm = 100.0;
        EXPECT_NEAR(middle_mm / found.period_mm, middle_mm / truth.period_mm, 0.1) << truth.period_mm;
        const auto there = [&](double period_mm, double phase_rad) {
            return 2.0 * std::numbers::pi * middle_mm / period_mm + phase_rad;
        };
        EXPECT_NEAR(std::remainder(there(found.period_mm, found.force_V.phase_rad) -
                                       there(truth.period_mm, truth.phase_rad),
                                   2.0 * std::numbers::pi),
                    0.0, 0.15)
            << truth.period_mm;
    }
}

/// As accurate as the start of a fit needs, also with additional dry friction everywhere.
TEST(PatchSearch, NarrowPatch_ComesBackWithLevelPlaceAndWidth) {
    for (const std::string_view beside : {"", "coulomb_friction:level_V=0.05"}) {
        constexpr double level_V = 0.1, centre_mm = 77.0, width_mm = 5.0;
        std::vector<plant::EffectSetting> truth{plant::parse_effect(
            fmt::format("rail_patch:level_V={},centre_mm={},width_mm={}", level_V, centre_mm, width_mm))};
        if (!beside.empty()) truth.push_back(plant::parse_effect(beside));
        const Evidence evidence = campaign(truth, {"macro-sweep", "macro-pulses", "macro-square"});
        const auto patches = strongest_patches(evidence, evidence.errors({}, everything(evidence)));
        ASSERT_FALSE(patches.empty());
        EXPECT_NEAR(patches.front().level_V, level_V, 0.4 * level_V) << beside;
        EXPECT_NEAR(patches.front().centre_mm, centre_mm, 0.6 * width_mm) << beside;
        EXPECT_NEAR(std::log2(patches.front().width_mm / width_mm), 0.0, 1.1) << beside;
    }
}

TEST(PatchSearch, FrictionThatIsTheSameEverywhere_IsNoPatch) {
    const Evidence evidence =
        campaign(effects({"coulomb_friction:level_V=0.05"}), {"macro-sweep", "macro-pulses"});
    const auto patches = strongest_patches(evidence, evidence.errors({}, everything(evidence)));
    for (const FrictionPatch& patch : patches) EXPECT_LT(patch.share, 0.05) << patch.centre_mm;
}

}  // namespace

}  // namespace fidservo
