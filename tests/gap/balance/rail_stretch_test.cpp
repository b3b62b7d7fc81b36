// SPDX-License-Identifier: GPL-3.0-or-later
// The stretch of a rail on which a carriage has slid most.
#include "gap/balance/rail_stretch.h"

#include <vector>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

using namespace gap;

std::vector<SlidingRow> rows_at(std::initializer_list<double> places_mm) {
    std::vector<SlidingRow> rows;
    for (const double place_mm : places_mm) {
        SlidingRow row{};
        row.position_mm = place_mm;
        rows.push_back(row);
    }
    return rows;
}

TEST(RailStretch, ShortRail_IsTakenWhole) {
    const RailStretch stretch = most_visited(rows_at({150.0, 20.0, 180.0, 35.0}));
    EXPECT_DOUBLE_EQ(stretch.low_mm, 20.0);
    EXPECT_DOUBLE_EQ(stretch.high_mm, 180.0);
    EXPECT_DOUBLE_EQ(stretch.length_mm(), 160.0);
}

TEST(RailStretch, OfAMotorThatTurnsOn_TheFourHundredMillimetresWithMostRows) {
    const std::vector<SlidingRow> rows =
        rows_at({0.0, 300.0, 5000.0, 5100.0, 5200.0, 5399.0, 5401.0, 9000.0, 9300.0});
    const RailStretch stretch = most_visited(rows);
    EXPECT_DOUBLE_EQ(stretch.low_mm, 5000.0);
    EXPECT_DOUBLE_EQ(stretch.high_mm, 5399.0);
    EXPECT_FALSE(stretch.holds(rows[0]));
    EXPECT_TRUE(stretch.holds(rows[2]));
    EXPECT_TRUE(stretch.holds(rows[5]));
    EXPECT_FALSE(stretch.holds(rows[6]));
}

TEST(RailStretch, OneRow_IsAStretchOfNoLength) {
    const RailStretch stretch = most_visited(rows_at({42.0}));
    EXPECT_DOUBLE_EQ(stretch.length_mm(), 0.0);
}

}  // namespace
}  // namespace fidservo
