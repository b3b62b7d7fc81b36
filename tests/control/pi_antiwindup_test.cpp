// SPDX-License-Identifier: GPL-3.0-or-later
#include "control/pi_antiwindup.h"

#include "core/micro_parameters.h"

#include <gtest/gtest.h>

namespace fidservo::control {
namespace {

constexpr PiGains published{3.0, 30.0, 30.0, 1.3, 1.9};

TEST(PiAntiwindup, OneTick_FollowsTheEquation) {
    PiState state = pi_start(published);
    EXPECT_DOUBLE_EQ(pi_update(published, 0.001, state, 0.1), 1.6);
    EXPECT_DOUBLE_EQ(state.integral_V, 1.3 + 0.001 * 30.0 * 0.1);
}

TEST(PiAntiwindup, Saturated_BackCalculationPullsTheIntegratorIn) {
    PiState state = pi_start(published);
    EXPECT_DOUBLE_EQ(pi_update(published, 0.001, state, 1.0), 1.9);
    EXPECT_DOUBLE_EQ(state.integral_V, 1.3 + 0.001 * (30.0 * 1.0 + 30.0 * (1.9 - 4.3)));
    for (int k = 0; k < 5000; ++k) pi_update(published, 0.001, state, 1.0);
    // At rest: ki e = kaw (w - c), so I = c + ki e / kaw - kp e.
    EXPECT_NEAR(state.integral_V, 1.9 + 1.0 - 3.0, 1e-9);
}

TEST(PiAntiwindup, Feedforward_IsAddedBeforeTheLimits) {
    PiState state{0.0};
    EXPECT_DOUBLE_EQ(pi_update(published, 0.001, state, 0.01, 1.5), 1.53);
    EXPECT_DOUBLE_EQ(pi_update(published, 0.001, state, 0.0, 0.0), 1.3);
}

}  // namespace
}  // namespace fidservo::control
