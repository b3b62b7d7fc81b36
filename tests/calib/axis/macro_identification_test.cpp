// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/macro/macro_identification.h"

#include "core/failure.h"
#include "core/result.h"
#include "core/rig.h"
#include "tests/calib/macro_drive.h"

#include <numbers>

#include <gtest/gtest.h>

namespace fidservo::calib {
namespace {

constexpr double gain = 198.84809, pole = 0.95833;
const double tau_s = -0.001 / std::log(pole);

/// Several amplitudes to both sides, then commands that rise slowly through the threshold on both sides.
std::vector<MacroTrace> full_campaign(const Rig& rig, double start_mm,
                                      const reference::Departures& departures = {}) {
    const Volts sine = [](double t_s) { return 4.2 * std::sin(2.0 * std::numbers::pi * 1.5 * t_s); };
    return {drive(rig, pulses({3.4, -3.4, 4.0, -4.0, 4.8, -4.8}), 3.0, start_mm, departures),
            drive(rig, sine, 2.0, start_mm, departures)};
}

TEST(MacroIdentification, OneVoltEffectiveStep_GivesGainAndTimeConstant) {
    const Rig rig = macro_rig();
    for (const double start_mm : {20.0, 20.013, 20.031}) {
        SCOPED_TRACE(start_mm);
        const MacroTrace step = drive(rig, step_to(4.0), 0.5, start_mm);
        const auto found = identify_macro({&step, 1}, macro_build(rig.macro));
        ASSERT_TRUE(found) << found.error().text;
        ASSERT_TRUE(found->gain_mm_per_s_per_V) << found->gain_mm_per_s_per_V.error().text;
        ASSERT_TRUE(found->time_constant_s) << found->time_constant_s.error().text;
        EXPECT_NEAR(found->gain_mm_per_s_per_V->value, gain, 0.001 * gain);
        EXPECT_NEAR(found->time_constant_s->value, tau_s, 0.005 * tau_s);
    }
}

TEST(MacroIdentification, OneVoltEffectiveStep_LeavesTheDeadZoneOpenAndSaysWhy) {
    const Rig rig = macro_rig();
    const MacroTrace step = drive(rig, step_to(4.0), 0.5, 20.0);
    const auto found = identify_macro({&step, 1}, macro_build(rig.macro));
    ASSERT_TRUE(found) << found.error().text;
    ASSERT_FALSE(found->zone_slope) << found->zone_slope->value << " +- " << found->zone_slope->std;
    EXPECT_EQ(found->zone_slope.error().reason, Reason::not_identifiable);
    EXPECT_NE(found->zone_slope.error().text.find("several amplitudes"), std::string::npos);
    EXPECT_FALSE(found->zone_offset_V);
    ASSERT_FALSE(found->threshold_V);
    EXPECT_NE(found->threshold_V.error().text.find("bounded only: between 0 and 4 V"), std::string::npos)
        << found->threshold_V.error().text;
    ASSERT_FALSE(found->drive_offset_V);
    EXPECT_NE(found->drive_offset_V.error().text.find("one side"), std::string::npos);
}

TEST(SlowMacroIdentification, SeveralAmplitudesAndWaveforms_GiveTheModifiedDeadZone) {
    const Rig rig = macro_rig();
    const auto found = identify_macro(full_campaign(rig, 100.0), macro_build(rig.macro));
    ASSERT_TRUE(found) << found.error().text;
    EXPECT_NEAR(found->gain_mm_per_s_per_V->value, gain, 0.001 * gain);
    EXPECT_NEAR(found->time_constant_s->value, tau_s, 0.005 * tau_s);
    EXPECT_NEAR(found->zone_offset_V->value, 0.364, 0.01 * 0.364);
    EXPECT_NEAR(found->zone_slope->value, 0.636, 0.01 * 0.636);
    EXPECT_NEAR(found->threshold_V->value, 3.0, 0.01);
    EXPECT_NEAR(found->friction_V->value, 0.0, 0.01);
    EXPECT_NEAR(found->drive_offset_V->value, 0.0, 0.005);
    EXPECT_LT(found->residual_count, 0.4);
    EXPECT_FALSE(found->threshold_assumed);
}

TEST(SlowMacroIdentification, PulsesAlone_GiveTheDeadZoneAtTheRigFilesThreshold) {
    const Rig rig = macro_rig();
    const MacroTrace trace = drive(rig, pulses({3.4, -3.4, 4.0, -4.0, 4.8, -4.8}), 3.0, 100.0);
    const auto found = identify_macro({&trace, 1}, macro_build(rig.macro));
    ASSERT_TRUE(found) << found.error().text;
    EXPECT_FALSE(found->threshold_V);
    EXPECT_TRUE(found->threshold_assumed);
    EXPECT_NEAR(found->zone_offset_V->value, 0.364, 0.02 * 0.364);
    EXPECT_NEAR(found->zone_slope->value, 0.636, 0.02 * 0.636);
}

TEST(MacroIdentification, FrictionAndOffset_AreToldFromTheDeadZone) {
    const Rig rig = macro_rig();
    reference::Departures departures;
    departures.drive.offset_V = 0.08;
    departures.friction.coulomb_V = 0.05;
    const auto found = identify_macro(full_campaign(rig, 100.0, departures), macro_build(rig.macro));
    ASSERT_TRUE(found) << found.error().text;
    EXPECT_NEAR(found->drive_offset_V->value, 0.08, 0.004);
    EXPECT_NEAR(found->friction_V->value, 0.05, 0.005);
    EXPECT_NEAR(found->gain_mm_per_s_per_V->value, gain, 0.01 * gain);
    EXPECT_NEAR(found->threshold_V->value, 3.0, 0.02);
}

TEST(MacroIdentification, RigWithoutDeadZone_GivesGainTimeConstantFrictionAndOffset) {
    const Rig rig = direct_rig();
    reference::Departures departures;
    departures.drive.offset_V = 0.1;
    departures.friction.coulomb_V = 0.6;
    const MacroTrace trace = drive(rig, pulses({2.0, -2.0, 4.0, -4.0, 1.0, -1.0}), 3.0, 100.0, departures);
    const auto found = identify_macro({&trace, 1}, macro_build(rig.macro));
    ASSERT_TRUE(found) << found.error().text;
    EXPECT_NEAR(found->gain_mm_per_s_per_V->value, 40.0, 0.1);
    EXPECT_NEAR(found->time_constant_s->value, tau_s, 0.01 * tau_s);
    EXPECT_NEAR(found->friction_V->value, 0.6, 0.006);
    EXPECT_NEAR(found->drive_offset_V->value, 0.1, 0.002);
    EXPECT_FALSE(found->threshold_V);
}

TEST(MacroIdentification, EndStop_IsLeftOut) {
    const Rig rig = macro_rig();
    const Volts into_the_stop = pulses({4.0, -4.0, 4.8}, 0.8, 0.6);
    const MacroTrace trace = drive(rig, into_the_stop, 2.4, 120.0);
    MacroBuild build = macro_build(rig.macro);
    for (const bool origin_known : {true, false}) {
        SCOPED_TRACE(origin_known);
        if (!origin_known) build.travel = {-1e9, 1e9};
        const auto found = identify_macro({&trace, 1}, build);
        ASSERT_TRUE(found) << found.error().text;
        ASSERT_TRUE(found->gain_mm_per_s_per_V) << found->gain_mm_per_s_per_V.error().text;
        ASSERT_TRUE(found->time_constant_s) << found->time_constant_s.error().text;
        EXPECT_GT(found->left_out_s, 0.1);
        EXPECT_NEAR(found->gain_mm_per_s_per_V->value, gain, 0.005 * gain);
        EXPECT_NEAR(found->time_constant_s->value, tau_s, 0.02 * tau_s);
    }
}

TEST(MacroIdentification, CarriageThatNeverMoved_IsRefused) {
    const Rig rig = macro_rig();
    const MacroTrace trace = drive(rig, step_to(2.5), 0.5, 100.0);
    const auto found = identify_macro({&trace, 1}, macro_build(rig.macro));
    ASSERT_FALSE(found);
    EXPECT_EQ(found.error().reason, Reason::not_identifiable);
    EXPECT_NE(found.error().text.find("never moved under commands up to 2.5 V"), std::string::npos);
}

TEST(MacroIdentification, MotionThatIsTooShort_LeavesGainAndTimeConstantOpen) {
    const Rig rig = macro_rig();
    const MacroTrace trace = drive(rig, step_to(4.0), 0.061, 100.0);
    const auto found = identify_macro({&trace, 1}, macro_build(rig.macro));
    ASSERT_TRUE(found) << found.error().text;
    ASSERT_FALSE(found->gain_mm_per_s_per_V) << found->gain_mm_per_s_per_V->value;
    ASSERT_FALSE(found->time_constant_s) << found->time_constant_s->value;
    EXPECT_NE(found->time_constant_s.error().text.find("too short"), std::string::npos);
}

TEST(MacroIdentification, DegenerateRecordings_AreRefusedWithoutACrash) {
    const MacroBuild build = macro_build(macro_rig().macro);
    const auto constant = [](std::size_t rows, double u, double y) {
        return MacroTrace{"constant", 0.001, std::vector(rows, u), std::vector(rows, y)};
    };
    EXPECT_FALSE(identify_macro({}, build));
    for (const MacroTrace& trace : {constant(0, 0.0, 0.0), constant(1, 4.0, 100.0), constant(59, 4.0, 100.0),
                                    constant(2000, 0.0, 100.0), constant(2000, 4.0, 100.0),
                                    constant(2000, 4.0, 0.0), constant(2000, 1e300, 1e12)}) {
        const auto found = identify_macro({&trace, 1}, build);
        ASSERT_FALSE(found) << trace.position_mm.size();
        EXPECT_EQ(found.error().reason, Reason::not_identifiable);
        EXPECT_FALSE(found.error().text.empty());
    }
}

TEST(SlowMacroIdentification, NoiseInPlaceOfARecording_NeitherCrashesNorYieldsNonsense) {
    const Rig rig = macro_rig();
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        SCOPED_TRACE(::testing::Message() << "seed " << seed);
        NoiseStream noise(seed, "garbage");
        MacroTrace trace{"garbage", 0.001, {}, {}};
        const double scale_mm = std::pow(10.0, 2.0 * noise.normal());
        for (int k = 0; k < 200; ++k) {
            trace.command_V.push_back(5.0 * noise.normal());
            trace.position_mm.push_back(100.0 + scale_mm * noise.normal());
        }
        const auto found = identify_macro({&trace, 1}, macro_build(rig.macro));
        if (!found) continue;
        for (const auto* estimate : {&found->gain_mm_per_s_per_V, &found->time_constant_s,
                                     &found->threshold_V, &found->zone_offset_V, &found->zone_slope})
            EXPECT_TRUE(!*estimate || (std::isfinite((*estimate)->value) && std::isfinite((*estimate)->std)));
    }
}

}  // namespace
}  // namespace fidservo::calib
