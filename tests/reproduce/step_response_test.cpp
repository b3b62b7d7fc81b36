// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/reproduce/step_response.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo::reproduce {
namespace {

constexpr double tick_s = 0.001;

/// A second-order step from 0 to 1: damping ratio z, natural frequency w.
std::vector<double> second_order(double z, double w, double duration_s) {
    std::vector<double> position(static_cast<std::size_t>(std::lround(duration_s / tick_s)));
    const double wd = w * std::sqrt(1.0 - z * z);
    for (std::size_t k = 0; k < position.size(); ++k) {
        const double t = tick_s * static_cast<double>(k);
        position[k] = 1.0 - std::exp(-z * w * t) * (std::cos(wd * t) + z * w / wd * std::sin(wd * t));
    }
    return position;
}

TEST(StepResponse, FirstOrder_SettlesAfterTheLogarithmOfTheBand) {
    std::vector<double> position(5000);
    for (std::size_t k = 0; k < position.size(); ++k)
        position[k] = 2.0 - 1.0 * std::exp(-tick_s * static_cast<double>(k) / 0.3);
    const StepResponse response = step_response(position, 1.0, 2.0, 0.05, 0.5, tick_s);
    EXPECT_NEAR(response.settling_s, 0.3 * std::log(20.0), tick_s);
    EXPECT_NEAR(response.dead_s, -0.3 * std::log(0.95), tick_s);
    EXPECT_EQ(response.overshoot, 0.0);
    EXPECT_NEAR(response.final_error, 0.0, 1e-6);
}

TEST(StepResponse, SecondOrder_OvershootsByTheClosedForm) {
    for (const double z : {0.2, 0.4, 0.6})
        EXPECT_NEAR(step_response(second_order(z, 30.0, 3.0), 0.0, 1.0, 0.02, 0.5, tick_s).overshoot,
                    std::exp(-std::numbers::pi * z / std::sqrt(1.0 - z * z)), 1e-3);
}

TEST(StepResponse, DownwardStep_IsTheMirrorImage) {
    std::vector<double> up = second_order(0.3, 20.0, 2.0), down = up;
    for (double& at : down) at = -at;
    const StepResponse a = step_response(up, 0.0, 1.0, 0.05, 0.3, tick_s),
                       b = step_response(down, 0.0, -1.0, 0.05, 0.3, tick_s);
    EXPECT_EQ(a.settling_s, b.settling_s);
    EXPECT_EQ(a.overshoot, b.overshoot);
    EXPECT_EQ(a.final_error, -b.final_error);
}

TEST(StepResponse, LimitCycle_NeverSettlesAndShowsItsAmplitude) {
    std::vector<double> position(4000);
    for (std::size_t k = 0; k < position.size(); ++k)
        position[k] = 1.0 + 0.2 * std::sin(2.0 * std::numbers::pi * tick_s * static_cast<double>(k));
    position.back() = 1.1;
    const StepResponse response = step_response(position, 0.0, 1.0, 0.05, 2.0, tick_s);
    EXPECT_EQ(response.settling_s, std::numeric_limits<double>::infinity());
    EXPECT_NEAR(response.tail_peak_to_peak, 0.4, 1e-4);
    EXPECT_NEAR(response.tail_rms, 0.2 / std::numbers::sqrt2, 1e-3);
}

TEST(StepResponse, AtTheTargetFromTheStart_IsSettledAtOnce) {
    EXPECT_EQ(step_response(std::vector(10, 1.0), 1.0, 1.0, 0.1, 0.005, tick_s).settling_s, 0.0);
}

TEST(HeldSetpoints, StretchesOfOneValue_AreFound) {
    const double none = std::numeric_limits<double>::quiet_NaN();
    const auto held = held_setpoints(std::vector{none, 1.0, 1.0, 2.0, none, 2.0});
    ASSERT_EQ(held.size(), 3u);
    EXPECT_EQ(held[0].begin, 1u);
    EXPECT_EQ(held[0].end, 3u);
    EXPECT_EQ(held[1].value, 2.0);
    EXPECT_EQ(held[2].begin, 5u);
}

}  // namespace
}  // namespace fidservo::reproduce
