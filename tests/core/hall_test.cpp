// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/hall.h"

#include <gtest/gtest.h>

namespace fidservo {
namespace {

constexpr HallParameters reference{2.5, 1.25, 2.0, 2.0, 0.12, 12, 5.0, 0.4};

TEST(Hall, TravelEnds_GiveThePublishedSpanAndResolution) {
    EXPECT_DOUBLE_EQ(hall_voltage_V(reference, 0.0), 1.25);
    EXPECT_DOUBLE_EQ(hall_voltage_V(reference, 4.0), 3.75);
    const double bits = (3.75 - 1.25) / hall_lsb_V(reference);
    EXPECT_NEAR(4000.0 / bits, 1.953, 0.001);
}

TEST(Hall, Inverse_IsExactWithinAndBeyondTheTravel) {
    for (double x = -1.4; x < 5.4; x += 0.01)
        EXPECT_NEAR(hall_position_mm(reference, hall_voltage_V(reference, x)), x, 1e-12);
}

TEST(Hall, LinearCurve_InvertsToo) {
    HallParameters linear = reference;
    linear.cubic = 0.0;
    EXPECT_NEAR(hall_position_mm(linear, hall_voltage_V(linear, 3.3)), 3.3, 1e-12);
}

TEST(Hall, CurveThatBendsTheOtherWay_InvertsEverywhere) {
    HallParameters bent = reference;
    for (const double cubic : {-0.9, -0.12, -1e-6}) {
        bent.cubic = cubic;
        for (double x = -4.0; x < 8.0; x += 0.01)
            EXPECT_NEAR(hall_position_mm(bent, hall_voltage_V(bent, x)), x, 1e-9) << cubic;
    }
}

TEST(Hall, Slope_IsTheDerivative) {
    constexpr double h = 1e-5;
    for (double x = 0.0; x <= 4.0; x += 0.25)
        EXPECT_NEAR(hall_slope_V_per_mm(reference, x),
                    (hall_voltage_V(reference, x + h) - hall_voltage_V(reference, x - h)) / (2 * h), 1e-8);
}

}  // namespace
}  // namespace fidservo
