// SPDX-License-Identifier: GPL-3.0-or-later
// Rigs that no explanation brings near the floor have the stated properties.
#include "src/selfcheck/draw/rough_draw.h"

#include "gap/residuals/accusation.h"
#include "src/selfcheck/draw/listed_effects.h"
#include "tests/effort.h"
#include "tests/reference_rig.h"
#include "tests/selfcheck/messy_cases.h"

#include <cstdint>

#include <gtest/gtest.h>

namespace fidservo::selfcheck {
namespace {

void expect_share(double part, double whole, const double (&limits)[2], const char* what) {
    EXPECT_GE(part, limits[0] * whole) << what;
    EXPECT_LE(part, limits[1] * whole) << what;
}

constexpr std::uint64_t seed = 3;

const Case& first_rough_case() {
    static const Case first = draw_rough_case(reference_rig(), seed, 0);
    return first;
}

void expect_of_one_stage(const Label& label) {
    ASSERT_EQ(label.effects.size(), 2u);
    ASSERT_TRUE(label.discrepancy);
    const TrueEffect& larger = label.effects[0];
    const TrueEffect& other = label.effects[1];
    EXPECT_NE(larger.class_name, other.class_name);
    EXPECT_TRUE(can_be_together(larger.class_name, other.class_name));
    EXPECT_EQ(gap::stage_of(other.block), gap::stage_of(larger.block));
    EXPECT_EQ(gap::stage_of(label.discrepancy->block), gap::stage_of(larger.block));
    expect_share(larger.gap_floors, 1.0, rough_floors, "the larger effect");
    expect_share(other.gap_floors, larger.gap_floors, rough_second, "the other one");
    expect_share(label.discrepancy->gap_floors, larger.gap_floors, rough_discrepancy, "discrepancy");
}

TEST(SlowRoughDraw, TwoLargeEffectsAndADiscrepancy_AreOfOneStage_AndKeepTheirGaps) {
    EXPECT_EQ(first_rough_case().label.kind, kind_of_rough_case(seed, 0));
    expect_of_one_stage(first_rough_case().label);
    for (int number = 1; number < fidservo::testing::draws(4, 1); ++number)
        expect_of_one_stage(draw_rough_case(reference_rig(), seed, static_cast<std::size_t>(number)).label);
}

TEST(SlowRoughDraw, SameSeedAndNumber_GiveTheSameRig) {
    const Case again = draw_rough_case(reference_rig(), seed, 0);
    EXPECT_EQ(first_rough_case().campaign_seed, again.campaign_seed);
    fidservo::testing::expect_same_label(first_rough_case().label, again.label);
    EXPECT_EQ(first_rough_case().label.discrepancy->size, again.label.discrepancy->size);
}

}  // namespace
}  // namespace fidservo::selfcheck
