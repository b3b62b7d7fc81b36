// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/plant/effects/effect_rig.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo::plant {
namespace {

/// Deflection of the platform after the carriage was brought to speed and left to coast: the ringing plus the
/// effect of the coasting's deceleration.
std::vector<double> ringing_mm(const StagePlant& plant, int ticks) {
    StageState state = start(plant, 50.0, 1);
    for (int k = 0; k < 200; ++k) advance(plant, state, 5.0, 0.0);
    std::vector<double> course;
    for (int k = 0; k < ticks; ++k) {
        advance(plant, state, 0.0, 0.0);
        course.push_back(state.micro->swing.position_mm);
    }
    return course;
}

TEST(MacroCoupling, EvenAcceleration_BendsTheFlexureByGainOverStiffness) {
    const PlatformSwing swing = make_platform_swing({40.0, 0.2, 0.7}, 0.001);
    SwingState state;
    for (int k = 0; k < 2000; ++k) advance(swing, state, {.acceleration_mm_per_s2 = 3000.0});
    const double w = 2.0 * std::numbers::pi * 40.0;
    EXPECT_NEAR(state.position_mm, -0.7 * 3000.0 / (w * w), 1e-12);
    EXPECT_NEAR(state.velocity_mm_per_s, 0.0, 1e-9);
}

TEST(MacroCoupling, NegativeGain_SwingsTheOtherWay) {
    const PlatformSwing swing = make_platform_swing({40.0, 0.2, 0.7}, 0.001),
                        other = make_platform_swing({40.0, 0.2, -0.7}, 0.001);
    SwingState state, mirrored;
    for (int k = 0; k < 60; ++k) {
        const double acceleration = k < 20 ? 3000.0 : -1000.0;
        advance(swing, state, {.acceleration_mm_per_s2 = acceleration});
        advance(other, mirrored, {.acceleration_mm_per_s2 = acceleration});
        EXPECT_NEAR(mirrored.position_mm, -state.position_mm, 1e-12);
    }
}

TEST(MacroCoupling, StepOfAcceleration_IsTheTextbooksStepResponse) {
    for (const double tick_s : {0.001, 0.0002, 0.007}) {
        const PlatformSwing swing = make_platform_swing({30.0, 0.05, 1.0}, tick_s);
        SwingState state;
        const double w = 2.0 * std::numbers::pi * 30.0, zeta = 0.05, wd = w * std::sqrt(1.0 - zeta * zeta);
        for (int k = 1; k <= 50; ++k) {
            advance(swing, state, {.acceleration_mm_per_s2 = 1000.0});
            const double t = k * tick_s;
            const double expected =
                -1000.0 / (w * w) *
                (1.0 - std::exp(-zeta * w * t) * (std::cos(wd * t) + zeta * w / wd * std::sin(wd * t)));
            EXPECT_NEAR(state.position_mm, expected, 1e-12) << "tick " << tick_s << " s, t " << t;
        }
    }
}

TEST(MacroCoupling, EvenJerk_IsFollowedLate) {
    const PlatformSwing swing = make_platform_swing({40.0, 0.2, 0.7}, 0.001);
    SwingState state;
    constexpr double jerk_mm_per_s3 = 2000.0;
    for (int k = 0; k < 2000; ++k)
        advance(swing, state, {jerk_mm_per_s3 * (k + 0.5) * 0.001, jerk_mm_per_s3});
    const double w = 2.0 * std::numbers::pi * 40.0;
    EXPECT_NEAR(state.position_mm, -0.7 * jerk_mm_per_s3 / (w * w) * (2.0 - 2.0 * 0.2 / w), 1e-12);
    EXPECT_NEAR(state.velocity_mm_per_s, -0.7 * jerk_mm_per_s3 / (w * w), 1e-9);
}

/// The phase advances by a quarter of a radian per tick, so that a mean over the tick would be wrong by up to
/// 12 % of the ringing.
TEST(MacroCoupling, StopWithinATick_RingsFromThereOn) {
    constexpr double speed_mm_per_s = 240.0, tick_s = 0.001, frequency_Hz = 40.0, zeta = 0.03;
    const double w = 2.0 * std::numbers::pi * frequency_Hz, wd = w * std::sqrt(1.0 - zeta * zeta);
    const PlatformSwing swing = make_platform_swing({frequency_Hz, zeta, 1.0}, tick_s);
    for (const double share : {0.0, 0.1, 0.5, 0.93, 1.0}) {
        SwingState state;
        advance(swing, state, shaking_of(share * tick_s * speed_mm_per_s, speed_mm_per_s, 0.0, tick_s));
        for (int k = 2; k <= 60; ++k) {
            advance(swing, state, {});
            const double since_s = (k - share) * tick_s;
            EXPECT_NEAR(state.position_mm,
                        speed_mm_per_s / wd * std::exp(-zeta * w * since_s) * std::sin(wd * since_s),
                        0.006 * speed_mm_per_s / wd)
                << share << " of the tick, tick " << k;
        }
    }
}

TEST(MacroCoupling, Ringing_HasTheResonanceFrequencyAndDecay) {
    const StagePlant plant = plant_with("macro_coupling:gain=0.5,frequency_Hz=25,damping_ratio=0.03");
    const std::vector<double> course = ringing_mm(plant, 1500);
    // After 0.5 s coasting has ended (tau = 23.5 ms); only the platform still moves.
    std::vector<double> crossings_s, peaks_mm;
    double peak = 0.0;
    for (std::size_t k = 500; k + 1 < course.size(); ++k) {
        peak = std::max(peak, std::abs(course[k]));
        if (course[k] < 0.0 && course[k + 1] >= 0.0) {
            crossings_s.push_back(0.001 * (static_cast<double>(k) + course[k] / (course[k] - course[k + 1])));
            peaks_mm.push_back(peak);
            peak = 0.0;
        }
    }
    ASSERT_GT(crossings_s.size(), 15U);
    const auto periods = static_cast<double>(crossings_s.size() - 1);
    const double frequency_Hz = periods / (crossings_s.back() - crossings_s.front());
    EXPECT_NEAR(frequency_Hz, 25.0 * std::sqrt(1.0 - 0.03 * 0.03), 0.005);
    const double decrement = std::log(peaks_mm[1] / peaks_mm.back()) / (periods - 1.0);
    // Peaks are seen at ticks only, up to half a tick (of 40 in a period) off: 0.3 % of the first and last
    // one.
    EXPECT_NEAR(decrement, 2.0 * std::numbers::pi * 0.03 / std::sqrt(1.0 - 0.03 * 0.03),
                0.006 / (periods - 1.0));
}

TEST(MacroCoupling, HallAndCamera_SeeTheSameSwing) {
    const StagePlant plant = plant_with("macro_coupling");
    const StagePlant nominal = make_stage_plant(reference_rig());
    StageState swinging = start(plant, 50.0, 1), stiff = start(nominal, 50.0, 1);
    double largest_mm = 0.0;
    for (int k = 0; k < 400; ++k) {
        const double macro_V = k % 100 < 50 ? 5.0 : -5.0;
        advance(plant, swinging, macro_V, 1.6);
        advance(nominal, stiff, macro_V, 1.6);
        const double swing_mm = swinging.micro->swing.position_mm;
        largest_mm = std::max(largest_mm, std::abs(swing_mm));
        EXPECT_EQ(swinging.axis.position_mm, stiff.axis.position_mm);
        EXPECT_NEAR(swinging.micro->position_mm - stiff.micro->position_mm, swing_mm, 1e-12);
        EXPECT_NEAR(camera_position_mm(swinging) - camera_position_mm(stiff), swing_mm, 1e-12);
    }
    EXPECT_GT(largest_mm, 0.1);
}

TEST(MacroCoupling, CarriageThatRunsIntoItsEnd_GivesItsMomentum) {
    const StagePlant plant = plant_with("macro_coupling:gain=1,frequency_Hz=10,damping_ratio=0.001");
    StageState state = start(plant, 190.0, 1), before = state;
    while (state.axis.position_mm < 200.0) {
        before = state;
        advance(plant, state, 5.0, 0.0);
    }
    const double lost_mm_per_s = before.axis.velocity_mm_per_s;
    EXPECT_GT(lost_mm_per_s, 100.0);
    // In a tick of 1/100 period the flexure itself changes the velocity by w^2 z T.
    const double w = 2.0 * std::numbers::pi * 10.0;
    const double spring = w * w * (std::abs(before.micro->swing.position_mm) + lost_mm_per_s * 0.001) * 0.001;
    EXPECT_NEAR(state.micro->swing.velocity_mm_per_s - before.micro->swing.velocity_mm_per_s, lost_mm_per_s,
                1.05 * spring);
    EXPECT_LT(spring, 0.5 * lost_mm_per_s);
}

}  // namespace
}  // namespace fidservo::plant
