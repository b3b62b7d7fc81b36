// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/hall_sensor.h"

#include "core/rig.h"
#include "tests/plant/reference_rig.h"

#include <cmath>

#include <gtest/gtest.h>

namespace fidservo::plant {
namespace {

HallSensor reference_sensor() {
    return make_hall_sensor(reference_rig().micro->hall);
}

TEST(HallSensor, EndsAndCentre_ReadThePublishedVoltages) {
    const HallSensor sensor = reference_sensor();
    EXPECT_DOUBLE_EQ(mean_reading_lsb(sensor, 0.0), 1024.0);  // 1.25 V of 5 V
    EXPECT_DOUBLE_EQ(mean_reading_lsb(sensor, 2.0), 2048.0);
    EXPECT_DOUBLE_EQ(mean_reading_lsb(sensor, 4.0), 3072.0);
    EXPECT_NEAR(4000.0 / 2048.0, 1.953, 5e-4) << "um per bit on average, published";
}

TEST(HallSensor, WithoutNoise_RoundsToTheNearestLsb) {
    HallSensor sensor = reference_sensor();
    sensor.parameters.noise_lsb = 0.0;
    NoiseStream noise(1, "hall");
    for (double x_mm = 0.0; x_mm <= 4.0; x_mm += 0.00037)
        ASSERT_EQ(sample(sensor, noise, x_mm), std::lround(mean_reading_lsb(sensor, x_mm)));
}

TEST(HallSensor, BeyondTheConverter_IsClamped) {
    HallSensor sensor = reference_sensor();
    NoiseStream noise(1, "hall");
    sensor.parameters.span_V = 10.0;
    EXPECT_EQ(sample(sensor, noise, 0.0), 0);
    EXPECT_EQ(sample(sensor, noise, 4.0), 4095);
}

TEST(HallSensor, Noise_HasTheStatedMeanAndRms) {
    const HallSensor sensor = reference_sensor();
    constexpr int count = 200000;
    // Readings at places that are spread evenly over an LSB, so that rounding adds 1/12 LSB^2.
    double sum = 0.0, squares = 0.0;
    NoiseStream noise(11, "hall");
    for (int k = 0; k < count; ++k) {
        const double x_mm = 1.0 + 0.5 * k / count;
        const double error = sample(sensor, noise, x_mm) - mean_reading_lsb(sensor, x_mm);
        sum += error;
        squares += error * error;
    }
    const double floor_lsb = std::sqrt(0.4 * 0.4 + 1.0 / 12.0);
    const double five_sigma = 5.0 * floor_lsb / std::sqrt(count);
    EXPECT_NEAR(sum / count, 0.0, five_sigma);
    EXPECT_NEAR(std::sqrt(squares / count), floor_lsb, five_sigma / std::sqrt(2.0));
}

TEST(HallSensor, EachReading_DrawsTheSameAmountOfNoise) {
    HallSensor sensor = reference_sensor();
    NoiseStream noisy(1, "hall"), silent(1, "hall");
    sample(sensor, noisy, 1.0);
    sensor.parameters.noise_lsb = 0.0;
    sample(sensor, silent, 1.0);
    EXPECT_EQ(noisy.position(), silent.position());
}

}  // namespace
}  // namespace fidservo::plant
