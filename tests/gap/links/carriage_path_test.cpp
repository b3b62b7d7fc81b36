// SPDX-License-Identifier: GPL-3.0-or-later
// Positions from counts, and a carriage's path between its windows.
#include "gap/links/carriage_path.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

using namespace gap;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
const plant::Encoder straight{.resolution_mm = 0.05};
const plant::Encoder rippled{.resolution_mm = 0.05,
                             .ripple = {.amplitude_mm = 0.06, .period_mm = 8.0, .phase_rad = 1.0}};

TEST(CarriagePath, PositionAtAReading_IsTheInverseOfTheEncoder) {
    for (const plant::Encoder& encoder : {straight, rippled})
        for (double place_mm = 3.0; place_mm < 30.0; place_mm += 0.37)
            EXPECT_NEAR(position_mm(encoder, plant::mean_reading_count(encoder, place_mm)), place_mm, 1e-8);
}

TEST(CarriagePath, WayPerCount_IsTheSlopeOfThePosition) {
    constexpr double step_count = 1e-3;
    for (const plant::Encoder& encoder : {straight, rippled}) {
        const double count = 123.0;
        const double slope =
            (position_mm(encoder, count + step_count) - position_mm(encoder, count - step_count)) /
            (2.0 * step_count);
        EXPECT_NEAR(mm_per_count(encoder, position_mm(encoder, count)), slope, 1e-7);
    }
    EXPECT_DOUBLE_EQ(mm_per_count(straight, 77.0), 0.05);
}

TEST(CarriagePath, BetweenWindows_ItIsAtTheCounts_AndWhereThereAreNoneOnALine) {
    CarriageRun run;
    run.tick_s = 1e-3;
    run.reading_count = {unknown, 10.0, unknown, unknown, 40.0, unknown};
    CarriagePath path = unknown_path(run.reading_count.size(), Followed::motion);
    fill(straight, run, path);
    const std::vector<double> expected{0.5, 0.5, 1.0, 1.5, 2.0, 2.0};
    for (std::size_t k = 0; k < expected.size(); ++k) EXPECT_NEAR(path.position_mm[k], expected[k], 1e-12);
    for (const double velocity : path.velocity_mm_per_s) EXPECT_TRUE(std::isfinite(velocity));
}

TEST(CarriagePath, SteadyMotion_HasItsVelocityAndNoAcceleration) {
    CarriageRun run;
    run.tick_s = 1e-3;
    for (int k = 0; k < 100; ++k) run.reading_count.push_back(2.0 * k);
    CarriagePath path = unknown_path(run.reading_count.size(), Followed::motion);
    fill(straight, run, path);
    for (std::size_t k = 0; k < 100; ++k) {
        EXPECT_NEAR(path.velocity_mm_per_s[k], 100.0, 1e-6);
        EXPECT_NEAR(path.acceleration_mm_per_s2[k], 0.0, 1e-3);
    }
}

TEST(CarriagePath, OfPlacesAlone_StoresNothingElse) {
    const CarriagePath path = unknown_path(7, Followed::places);
    EXPECT_EQ(path.position_mm.size(), 7U);
    EXPECT_TRUE(std::isnan(path.position_mm.front()));
    EXPECT_TRUE(path.velocity_mm_per_s.empty());
    EXPECT_TRUE(path.entering_mm.empty());
}

TEST(CarriagePath, WithinHalfACount_IsNotPulled_BeyondItIsPulledToTheCounts) {
    constexpr std::size_t lead = 10, rows = 60;
    CarriageRun run;
    run.tick_s = 1e-3;
    run.reading_count.assign(rows, 20.0);
    const WindowRows window{.lead = 0, .first = lead, .end = rows};
    const auto pulled_by = [&](double off_count) {
        CarriagePath before = unknown_path(lead, Followed::places),
                     path = unknown_path(rows, Followed::places);
        before.position_mm.assign(lead, 0.05 * (20.0 + off_count));
        path.position_mm.assign(rows, 0.05 * (20.0 + off_count));
        pull_to_counts(straight, run, window, before, path);
        return path.position_mm[rows / 2] / 0.05 - (20.0 + off_count);
    };
    EXPECT_DOUBLE_EQ(pulled_by(0.4), 0.0);
    EXPECT_NEAR(pulled_by(3.0), -2.5, 1e-9);
    EXPECT_NEAR(pulled_by(-2.0), 1.5, 1e-9);
}

TEST(CarriagePath, FadesIntoTheNextWindowWithoutAJump) {
    constexpr std::size_t lead = 4;
    CarriagePath path = unknown_path(10, Followed::motion), before = unknown_path(lead, Followed::motion);
    for (std::vector<double>* values :
         {&path.position_mm, &path.velocity_mm_per_s, &path.acceleration_mm_per_s2, &path.jerk_mm_per_s3})
        values->assign(10, 1.0);
    for (std::vector<double>* values : {&before.position_mm, &before.velocity_mm_per_s,
                                        &before.acceleration_mm_per_s2, &before.jerk_mm_per_s3})
        values->assign(lead, 2.0);
    fade_in({.lead = 2, .first = 2 + lead, .end = 10}, before, path);
    EXPECT_DOUBLE_EQ(path.position_mm[1], 1.0);
    for (std::size_t k = 0; k < lead; ++k) {
        EXPECT_NEAR(path.position_mm[2 + k], 1.0 + (static_cast<double>(k) + 0.5) / lead, 1e-12);
        EXPECT_DOUBLE_EQ(path.entering_mm[2 + k], 2.0);
    }
}

}  // namespace
}  // namespace fidservo
