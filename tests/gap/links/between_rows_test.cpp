// SPDX-License-Identifier: GPL-3.0-or-later
// Interpolation between rows, where the exact value is a polynomial or a line with a corner.
#include "gap/links/between_rows.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

using namespace gap;

constexpr double tick_s = 0.001;

std::vector<double> times(std::size_t rows) {
    std::vector<double> time_s;
    for (std::size_t k = 0; k < rows; ++k) time_s.push_back(tick_s * static_cast<double>(k));
    return time_s;
}

TEST(BetweenRows, Moment_IsTheRowBeforeAndTheShareOfTheWayToTheNext) {
    std::vector<double> time_s = times(5);
    time_s.back() += 0.010;
    const Moment early = moment_at(time_s, tick_s, -1.0), within = moment_at(time_s, tick_s, 0.00125),
                 in_gap = moment_at(time_s, tick_s, 0.0085), late = moment_at(time_s, tick_s, 1.0);
    EXPECT_EQ(early.row, 0U);
    EXPECT_EQ(early.share, 0.0);
    EXPECT_EQ(within.row, 1U);
    EXPECT_NEAR(within.share, 0.25, 1e-9);
    EXPECT_TRUE(within.is_tick);
    EXPECT_EQ(in_gap.row, 3U);
    EXPECT_NEAR(in_gap.share, 0.5, 1e-9);
    EXPECT_FALSE(in_gap.is_tick);
    EXPECT_EQ(late.row, 3U);
    EXPECT_EQ(late.share, 1.0);
    EXPECT_EQ(nearest_row(time_s, tick_s, 0.0013), 1U);
    EXPECT_EQ(nearest_row(time_s, tick_s, 0.0017), 2U);
}

TEST(BetweenRows, CarriageOnACubic_IsInterpolatedExactly) {
    const auto place_mm = [](double t_s) {
        return 3.0 + 40.0 * t_s - 900.0 * t_s * t_s + 2e5 * t_s * t_s * t_s;
    };
    const auto mm_per_s = [](double t_s) { return 40.0 - 1800.0 * t_s + 6e5 * t_s * t_s; };
    CarriagePath path;
    for (const double t_s : times(4)) {
        path.position_mm.push_back(place_mm(t_s));
        path.velocity_mm_per_s.push_back(mm_per_s(t_s));
    }
    EXPECT_NEAR(carriage_mm(path, {1, 0.3, true}, tick_s), place_mm(0.0013), 1e-12);
}

/// The heater is switched on at row 5. What differs from the model goes on as it did.
TEST(BetweenRows, ReadingBesideACornerOfTheModel_IsNotRoundedOff) {
    const auto model_lsb = [](double row) { return 2000.0 + 15.0 * std::max(0.0, row - 5.0); };
    const auto differs_lsb = [](double row) { return 0.4 * row - 0.03 * row * row; };
    SmoothedReading reading;
    for (std::size_t k = 0; k < 10; ++k) {
        const auto row = static_cast<double>(k);
        reading.model_lsb.push_back(model_lsb(row));
        reading.reading_lsb.push_back(model_lsb(row) + differs_lsb(row));
    }
    double worst_of_cubic_lsb = 0.0;
    for (const std::size_t row : {3, 4, 5, 6})
        for (const double share : {0.0, 0.25, 0.5, 0.9}) {
            const double at = static_cast<double>(row) + share, exact_lsb = model_lsb(at) + differs_lsb(at);
            EXPECT_NEAR(reading_lsb(reading, {row, share, true}), exact_lsb, 1e-9) << at;
            worst_of_cubic_lsb = std::max(
                worst_of_cubic_lsb, std::abs(between(reading.reading_lsb, {row, share, true}) - exact_lsb));
        }
    EXPECT_GT(worst_of_cubic_lsb, 0.5);
}

/// The wire begins to transform at a quarter of the tick after row 3.
TEST(BetweenRows, ReadingWhoseModelBendsWithinATick_FollowsIt) {
    const auto model_lsb = [](double row) { return 2000.0 + 36.0 * std::max(0.0, row - 3.25); };
    SmoothedReading reading;
    for (std::size_t k = 0; k < 8; ++k) {
        const auto row = static_cast<double>(k);
        reading.model_lsb.push_back(model_lsb(row));
        for (const double share : {0.25, 0.5, 0.75})
            reading.model_bends_lsb.push_back(
                model_lsb(row + share) - (model_lsb(row) + share * (model_lsb(row + 1.0) - model_lsb(row))));
    }
    reading.reading_lsb = reading.model_lsb;
    for (const std::size_t row : {2, 3, 4})
        for (const double share : {0.0, 0.1, 0.25, 0.4, 0.5, 0.9, 1.0})
            EXPECT_NEAR(reading_lsb(reading, {row, share, true}), model_lsb(static_cast<double>(row) + share),
                        1e-9)
                << row << " " << share;
}

}  // namespace
}  // namespace fidservo
