// SPDX-License-Identifier: GPL-3.0-or-later
#include "control/nonlinear_pd.h"

#include "core/rig.h"
#include "plant/stage_plant.h"
#include "tests/plant/reference_rig.h"

#include <cmath>

#include <gtest/gtest.h>

namespace fidservo::control {
namespace {

constexpr PdGains published{0.0124593, -0.0112178, 3.0};

TEST(NonlinearPd, FirstAndSecondTick_FollowTheEquation) {
    PdState state;
    EXPECT_DOUBLE_EQ(pd_update(published, 5.0, state, 100.0), 1.24593 + 3.0);
    EXPECT_DOUBLE_EQ(pd_update(published, 5.0, state, 90.0), 0.0124593 * 90 - 0.0112178 * 100 - 3.0);
    EXPECT_DOUBLE_EQ(pd_update(published, 5.0, state, 0.0), -0.0112178 * 90 - 3.0);
    EXPECT_DOUBLE_EQ(pd_update(published, 5.0, state, 0.0), 0.0);
}

TEST(NonlinearPd, LargeError_IsSaturated) {
    PdState state;
    EXPECT_DOUBLE_EQ(pd_update(published, 5.0, state, 1e6), 5.0);
    EXPECT_DOUBLE_EQ(pd_update(published, 5.0, state, -1e6), -5.0);
}

/// Reference-rig.md: within one count of a 50 mm step in 0.4 s, two counts of overshoot at most.
TEST(NonlinearPd, FiftyMillimetreStepOnThePlant_SettlesAsPublished) {
    const Rig& rig = reference_rig();
    const plant::StagePlant stage = plant::make_stage_plant(rig);
    for (double sub_count = 0.0; sub_count < 1.0; sub_count += 0.1) {
        SCOPED_TRACE(::testing::Message() << "start within the count: " << sub_count);
        plant::StageState truth = plant::start(stage, 100.0 + 0.05 * sub_count, 1);
        PdState pd;
        double highest = 0.0, late_error = 0.0, last_error = 0.0;
        for (int k = 0; k < 4000; ++k) {
            const double error = 1000.0 - static_cast<double>(plant::sample(stage, truth).encoder_count);
            plant::advance(stage, truth, pd_update(*rig.macro.pd, rig.macro.command_limit_V, pd, error), 0.0);
            highest = std::max(highest, -error);
            if (k >= 400) late_error = std::max(late_error, std::abs(error));
            last_error = error;
        }
        EXPECT_LE(highest, 2.0);
        EXPECT_LE(late_error, 1.0);
        EXPECT_EQ(last_error, 0.0);
    }
}

TEST(Pid, OneTick_FollowsTheEquation) {
    const PidGains gains{0.01, 0.02, 0.0005};
    PidState state;
    EXPECT_NEAR(pid_update(gains, 5.0, 0.001, state, 4.0), 0.01 * 4 + 0.02 * 0.001 * 4 + 0.0005 * 4 / 0.001,
                1e-12);
    EXPECT_NEAR(pid_update(gains, 5.0, 0.001, state, 4.0), 0.01 * 4 + 2 * 0.02 * 0.001 * 4, 1e-12);
}

/// The published benchmark: without a friction inverse the carriage sticks while the integral ramps, breaks
/// away, overshoots and sticks again.
TEST(Pid, OnThePlant_FallsIntoAStickSlipLimitCycle) {
    const Rig& rig = reference_rig();
    const plant::StagePlant stage = plant::make_stage_plant(rig);
    for (const double step_count : {400.0, 777.0, 1000.0}) {
        SCOPED_TRACE(step_count);
        plant::StageState truth = plant::start(stage, 100.005, 1);
        PidState pid;
        int slips = 0, still_ticks = 0, side_changes = 0;
        double side = 0.0, first_overshoot = 0.0;
        for (int k = 0; k < 60'000; ++k) {
            const double error = step_count - static_cast<double>(plant::sample(stage, truth).encoder_count);
            plant::advance(stage, truth,
                           pid_update(*rig.macro.pid, rig.macro.command_limit_V, rig.tick_s, pid, error),
                           0.0);
            const bool moves = std::abs(truth.axis.velocity_mm_per_s) > 1.0;
            if (moves && still_ticks > 500) ++slips;
            still_ticks = moves ? 0 : still_ticks + 1;
            if (k < 1500) first_overshoot = std::max(first_overshoot, -error);
            if (still_ticks == 500 && error != 0.0) {
                side_changes += side * error < 0.0;
                side = error;
            }
        }
        EXPECT_GE(slips, 4);
        EXPECT_GE(side_changes, 3);
        EXPECT_LE(first_overshoot, 100.0);
    }
}

}  // namespace
}  // namespace fidservo::control
