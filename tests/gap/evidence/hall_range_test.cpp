// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/evidence/hall_range.h"

#include "core/random.h"
#include "core/rig.h"
#include "tests/reference_rig.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace fidservo::gap {
namespace {

/// Swings between 1000 and 3000 LSB, with a rest at either end, noise and an end of the amplifier's range.
Recording swing(std::uint64_t seed, double noise_lsb, double highest_adc) {
    constexpr int rows = 12000, rest = 2000;
    NoiseStream noise(seed, "hall range");
    Recording recording;
    for (int k = 0; k < rows; ++k) {
        const double turn = std::clamp((k - rest) / static_cast<double>(rows - 2 * rest), 0.0, 1.0);
        StageRow row;
        row.micro_command_V = turn > 0.0 && turn < 1.0 ? 1.5 + 0.3 * turn : 0.0;
        const double level = 2000.3 - 1000.0 * std::cos(3.0 * 3.14159265 * turn);
        row.hall_adc = std::min(highest_adc, std::round(level + noise_lsb * noise.normal()));
        recording.rows.push_back(row);
    }
    return recording;
}

TEST(HallRange, WholeSwing_IsInsideTheConvertersRange) {
    for (std::uint64_t seed = 1; seed <= 40; ++seed)
        for (const double noise_lsb : {0.0, 0.05, 0.25, 0.4, 2.0}) {
            const HallRange range = hall_range({swing(seed, noise_lsb, 4095.0)}, reference_rig().micro->hall);
            EXPECT_EQ(range.low_adc, 0.0) << noise_lsb << " LSB, seed " << seed;
            EXPECT_EQ(range.high_adc, 4095.0) << noise_lsb << " LSB, seed " << seed;
        }
}

TEST(HallRange, ReadingThatStandsStillAtItsHighest_EndsThere) {
    const HallRange range =
        hall_range({swing(1, 0.4, 4095.0), swing(2, 0.4, 2600.0)}, reference_rig().micro->hall);
    EXPECT_EQ(range.high_adc, 4095.0) << "another recording goes beyond";
    const HallRange clipped =
        hall_range({swing(3, 0.4, 2600.0), swing(4, 0.4, 2600.0)}, reference_rig().micro->hall);
    EXPECT_EQ(clipped.high_adc, 2600.0);
    EXPECT_EQ(clipped.low_adc, 0.0);
    EXPECT_TRUE(std::isnan(within(clipped, 2600.0)));
    EXPECT_EQ(within(clipped, 2599.0), 2599.0);
}

}  // namespace
}  // namespace fidservo::gap
