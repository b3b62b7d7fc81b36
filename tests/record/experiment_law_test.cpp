// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/simulation/experiment_law.h"

#include "core/rig.h"
#include "src/files/rig/rig_file.h"

#include <cmath>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

Experiment both_loops(MacroLoop loop) {
    return {.kind = "both",
            .duration_s = 1.0,
            .macro_setpoint_mm = [](double t_s) { return 100.0 + 3.0 * t_s; },
            .macro_loop = loop,
            .micro_setpoint_mm = [](double t_s) { return 2.0 + t_s; }};
}

/// An encoder that counts from elsewhere changes nothing but the numbers it shows.
TEST(ExperimentLaw, EncoderThatCountsFromElsewhere_SameCommands) {
    const Rig rig = load_rig(reference_rig_file());
    for (const MacroLoop loop : {MacroLoop::nonlinear_pd, MacroLoop::benchmark_pid}) {
        const Experiment experiment = both_loops(loop);
        ExperimentLoops here, elsewhere;
        for (int k = 0; k < 200; ++k) {
            const double t_s = 0.001 * k, count = 1990.0 + k % 17;
            StageRow a{.encoder_count = count, .hall_adc = 1500.0 + k},
                b{.encoder_count = count - 3210.0, .hall_adc = 1500.0 + k};
            command_tick(rig, experiment, 0.0, t_s, here, a);
            command_tick(rig, experiment, -3210.0, t_s, elsewhere, b);
            ASSERT_EQ(a.macro_command_V, b.macro_command_V) << k;
            ASSERT_EQ(a.micro_command_V, b.micro_command_V) << k;
            ASSERT_EQ(a.macro_setpoint_mm, b.macro_setpoint_mm) << k;
        }
    }
}

TEST(ExperimentLaw, FirstTickOfThePd_IsItsEquation) {
    const Rig rig = load_rig(reference_rig_file());
    ExperimentLoops loops;
    StageRow row{.encoder_count = -1210.0, .hall_adc = 1024.0};
    command_tick(rig, both_loops(MacroLoop::nonlinear_pd), -3210.0, 0.0, loops, row);
    EXPECT_EQ(row.macro_command_V, 0.0) << "it stands at its setpoint";
    loops = {};
    row.encoder_count -= 40.0;
    command_tick(rig, both_loops(MacroLoop::nonlinear_pd), -3210.0, 0.0, loops, row);
    EXPECT_NEAR(row.macro_command_V, 3.0 + 0.0124593 * 40.0, 1e-12);
}

TEST(ExperimentLaw, Controllers_AreThoseOfTheLoopsThatAreClosed) {
    EXPECT_FALSE(controllers_of({.kind = "rest"}));
    EXPECT_FALSE(controllers_of({.kind = "pulses", .macro_V = [](double) { return 4.0; }}));
    const auto pd = controllers_of(both_loops(MacroLoop::nonlinear_pd));
    EXPECT_EQ(pd->macro, "nonlinear_pd");
    EXPECT_EQ(pd->micro, "pi_antiwindup");
    EXPECT_EQ(controllers_of(both_loops(MacroLoop::benchmark_pid))->macro, "benchmark_pid");
    const auto macro_only = controllers_of({.kind = "a", .macro_setpoint_mm = [](double) { return 4.0; }});
    EXPECT_EQ(macro_only->micro, "");
}

}  // namespace
}  // namespace fidservo
