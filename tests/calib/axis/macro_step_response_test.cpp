// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/macro/macro_step_response.h"

#include "core/rig.h"
#include "tests/calib/macro_drive.h"

#include <gtest/gtest.h>

namespace fidservo::calib {
namespace {

constexpr double gain = 198.84809, pole = 0.95833, numerator_count = 0.16572, resolution_mm = 0.05;
const double tau_s = -0.001 / std::log(pole);

/// The command less its dead zone, by eq. (7).
std::vector<double> compensated(const MacroTrace& trace) {
    std::vector<double> volts;
    volts.reserve(trace.command_V.size());
    for (const double u : trace.command_V)
        volts.push_back(std::abs(u) < 3.0 ? 0.0 : std::copysign(0.364 + 0.636 * (std::abs(u) - 3.0), u));
    return volts;
}

TEST(MacroStepResponse, OneVoltStep_GivesEquation6WithoutBiasFromRounding) {
    // Over evenly spread places within a count, so that the rounding differs; the mean shows the bias.
    constexpr int starts = 16;
    double pole_sum = 0.0, gain_sum = 0.0;
    for (int i = 0; i < starts; ++i) {
        SCOPED_TRACE(i);
        const MacroTrace step = drive(macro_rig(), step_to(4.0), 0.4, 20.0 + resolution_mm * i / starts);
        const auto model = step_model(step, compensated(step), resolution_mm);
        ASSERT_TRUE(model) << model.error().text;
        EXPECT_NEAR(model->gain_mm_per_s_per_V, gain, 0.01 * gain);
        EXPECT_NEAR(model->time_constant_s, tau_s, 0.01 * tau_s);
        EXPECT_NEAR(model->numerator_count_per_V, numerator_count, 0.01 * numerator_count);
        pole_sum += model->time_constant_s / starts;
        gain_sum += model->gain_mm_per_s_per_V / starts;
    }
    EXPECT_NEAR(pole_sum, tau_s, 0.001 * tau_s);
    EXPECT_NEAR(gain_sum, gain, 0.0002 * gain);
}

TEST(MacroStepResponse, RisingSteps_GiveTheThreshold) {
    for (const double side : {1.0, -1.0}) {
        const Volts rising = rising_steps(2.81, 0.02);
        const MacroTrace trace = drive(
            macro_rig(), [&](double t_s) { return side * rising(t_s); }, 3.0, 100.0);
        const auto threshold = threshold_from_rising_steps(trace, resolution_mm, side);
        ASSERT_TRUE(threshold) << threshold.error().text;
        EXPECT_NEAR(threshold->value, 3.0, 0.0101);
        EXPECT_NEAR(threshold->std, 0.02 / std::sqrt(12.0), 1e-9);
    }
}

TEST(SlowMacroStepResponse, WholeProcedure_AgreesWithTheGeneralIdentification) {
    const Rig rig = macro_rig();
    const MacroTrace rising = drive(rig, rising_steps(2.805, 0.01), 4.6, 60.0);
    std::vector<MacroTrace> traces{rising};
    std::vector<SteadySpeed> speeds;
    for (const double u : {3.3, 3.6, 4.0, 4.5}) {
        traces.push_back(drive(rig, step_to(u), 0.4, 20.0));
        std::vector<double> unit(traces.back().command_V.size());
        std::ranges::transform(traces.back().command_V, unit.begin(),
                               [](double v) { return v > 0.0 ? 1.0 : 0.0; });
        const auto model = step_model(traces.back(), unit, resolution_mm);
        ASSERT_TRUE(model) << model.error().text;
        speeds.push_back({u, model->gain_mm_per_s_per_V});
    }
    const auto threshold = threshold_from_rising_steps(rising, resolution_mm, 1.0);
    ASSERT_TRUE(threshold) << threshold.error().text;
    const auto zone = dead_zone_from_amplitudes(speeds, threshold->value, 4.0);
    ASSERT_TRUE(zone) << zone.error().text;
    EXPECT_NEAR(zone->offset_V, 0.364, 0.02 * 0.364);
    EXPECT_NEAR(zone->slope, 0.636, 0.02 * 0.636);
    EXPECT_NEAR(zone->gain_mm_per_s_per_V, gain, 0.01 * gain);

    const auto general = identify_macro(traces, macro_build(rig.macro));
    ASSERT_TRUE(general) << general.error().text;
    ASSERT_TRUE(general->threshold_V) << general->threshold_V.error().text;
    EXPECT_NEAR(general->threshold_V->value, threshold->value, 0.0051);
    EXPECT_NEAR(general->zone_offset_V->value, zone->offset_V, 0.01);
    EXPECT_NEAR(general->zone_slope->value, zone->slope, 0.005);
    EXPECT_NEAR(general->gain_mm_per_s_per_V->value, zone->gain_mm_per_s_per_V, 0.002 * gain);
}

TEST(MacroStepResponse, RecordingsOfOtherExperiments_AreRefused) {
    const MacroTrace rest = drive(macro_rig(), step_to(0.0), 0.2, 20.0);
    EXPECT_FALSE(step_model(rest, compensated(rest), resolution_mm));
    const std::vector<double> ones(rest.command_V.size(), 1.0);
    EXPECT_FALSE(step_model(rest, ones, resolution_mm));
    EXPECT_FALSE(threshold_from_rising_steps(rest, resolution_mm, 1.0));
    const MacroTrace empty{"empty", 0.001, {}, {}};
    EXPECT_FALSE(step_model(empty, {}, resolution_mm));
    EXPECT_FALSE(threshold_from_rising_steps(empty, resolution_mm, 1.0));
    const MacroTrace step = drive(macro_rig(), step_to(4.0), 0.2, 20.0);
    EXPECT_FALSE(threshold_from_rising_steps(step, resolution_mm, 1.0)) << "no smaller command was tried";
    EXPECT_FALSE(dead_zone_from_amplitudes({}, 3.0, 4.0));
    const std::vector<SteadySpeed> same{{4.0, 199.0}, {4.01, 200.0}};
    EXPECT_FALSE(dead_zone_from_amplitudes(same, 3.0, 4.0));
}

}  // namespace
}  // namespace fidservo::calib
