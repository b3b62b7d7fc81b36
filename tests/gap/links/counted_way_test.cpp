// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/links/counted_way.h"

#include "plant/effects/catalogue.h"
#include "plant/stage_plant.h"
#include "tests/reference_rig.h"

#include <cmath>
#include <initializer_list>
#include <limits>

#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;

constexpr double mm_per_count = 0.05;

/// Counts of ways, one after the other, at so many rows a count; a negative way goes left.
CountedWay ways(std::initializer_list<int> ways_count, int rows_a_count = 2) {
    std::vector<double> readings{1000.0};
    for (const int way : ways_count)
        for (int k = 0; k < std::abs(way); ++k) {
            const double next = readings.back() + (way < 0 ? -1.0 : 1.0);
            readings.insert(readings.end(), static_cast<std::size_t>(rows_a_count), next);
        }
    return counted_way(readings);
}

plant::MacroAxis axis_with(const char* effect) {
    const std::vector settings{plant::parse_effect(effect)};
    return plant::make_stage_plant(reference_rig(), settings).axis;
}

TEST(CountedWay, PlaceWhereACountChanges_IsTheBorderOfTheTwo) {
    const CountedWay way = counted_way({7.0, 8.0, 9.0, 8.0, 7.0});
    EXPECT_EQ(way.place_count, (std::vector{7.0, 7.5, 8.5, 8.5, 7.5}));
    ASSERT_EQ(way.turns.size(), 3U);
    EXPECT_EQ(way.turns[2].place_count, 8.5);
}

TEST(CountedWay, ReadingToAndFroBetweenTwoCounts_IsNoWay) {
    std::vector<double> readings{5.0, 6.0};
    for (int k = 0; k < 50; ++k) readings.push_back(5.0 + k % 2);
    EXPECT_EQ(counted_way(readings).turns.size(), 2U);
}

TEST(CountedWay, MissingReadings_LeaveThePlaceAsItWas) {
    const double none = std::numeric_limits<double>::quiet_NaN();
    const CountedWay way = counted_way({none, 5.0, none, 7.0});
    EXPECT_TRUE(std::isnan(way.place_count[0]));
    EXPECT_EQ(way.place_count[2], 5.0);
    EXPECT_EQ(way.place_count[3], 6.5);
}

TEST(CountedWay, Bristles_AreBentAsEachWayBentThem) {
    const plant::MacroAxis axis = axis_with("presliding:level_V=0.05,distance_um=500");
    const CountedWay way = ways({400, -10});
    const double back_mm = 9.0 * mm_per_count;  // the first count back is within the border
    EXPECT_NEAR(remembered(way, axis, mm_per_count, way.place_count.size() - 1).bristle_bend,
                -1.0 + 2.0 * std::exp(-back_mm / 0.5), 1e-9);
    EXPECT_EQ(remembered(way, axis, mm_per_count, 0).bristle_bend, 0.0);
}

TEST(CountedWay, CarriageWithPlay_IsBehindWhatDrivesIt) {
    const plant::MacroAxis axis = axis_with("backlash:width_um=300");
    const CountedWay way = ways({40, -10});
    EXPECT_DOUBLE_EQ(remembered(way, axis, mm_per_count, 60).play_mm, -0.15);
    EXPECT_DOUBLE_EQ(remembered(way, axis, mm_per_count, way.place_count.size() - 1).play_mm, 0.15);
}

TEST(CountedWay, OnALongWay_AllThatWasBeforeIsForgotten) {
    const plant::MacroAxis axis = axis_with("presliding:level_V=0.05,distance_um=100");  // 28 counts
    constexpr int rows_a_count = 10;
    const CountedWay way = ways({-20, 60}, rows_a_count);
    const auto at = [](std::size_t counts) { return rows_a_count * (20 + counts); };
    EXPECT_FALSE(is_remembered(way, axis, mm_per_count, at(20))) << "too short";
    EXPECT_TRUE(is_remembered(way, axis, mm_per_count, at(35)));
    EXPECT_FALSE(is_remembered(way, axis, mm_per_count, at(55))) << "nothing says that it goes on";
}

}  // namespace

}  // namespace fidservo
