// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/record/travel_watch.h"

#include "core/rig.h"
#include "src/files/rig/rig_file.h"

#include <gtest/gtest.h>

namespace fidservo {
namespace {

constexpr double tick_s = 0.001;

/// Where a carriage that moves steadily is first said to leave its travel, mm.
double first_warning_mm(double from_mm, double speed_mm_per_s) {
    const TravelWatch watch{0.5, 199.5, 0.0235, tick_s};
    TravelWatchState state;
    double place_mm = from_mm;
    while (!leaves_travel(watch, state, place_mm)) place_mm += speed_mm_per_s * tick_s;
    return place_mm;
}

TEST(TravelWatch, SteadySpeed_IsSaidWhereItStillCoastsToRestInside) {
    for (const double speed_mm_per_s : {10.0, 100.0, 330.0}) {
        const double step_mm = speed_mm_per_s * tick_s, coast_mm = speed_mm_per_s * 0.0235;
        EXPECT_NEAR(first_warning_mm(100.0, speed_mm_per_s), 199.5 - coast_mm, 1.01 * step_mm);
        EXPECT_NEAR(first_warning_mm(100.0, -speed_mm_per_s), 0.5 + coast_mm, 1.01 * step_mm);
    }
}

TEST(TravelWatch, AtRest_OnlyThePlaceCounts) {
    const TravelWatch watch = travel_watch(load_rig(reference_rig_file()));
    for (const auto& [place_mm, leaves] :
         {std::pair(0.4, true), {0.6, false}, {199.4, false}, {199.6, true}}) {
        TravelWatchState state;
        EXPECT_EQ(leaves_travel(watch, state, place_mm), leaves) << place_mm;
        EXPECT_EQ(leaves_travel(watch, state, place_mm), leaves) << place_mm;
    }
}

TEST(TravelWatch, ReferenceRig_CoastsOverItsTimeConstant) {
    EXPECT_NEAR(travel_watch(load_rig(reference_rig_file())).coast_s, 0.0235, 0.0001);
}

}  // namespace
}  // namespace fidservo
