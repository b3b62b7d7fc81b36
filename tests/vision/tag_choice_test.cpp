// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/tags/tag_choice.h"

#include <numbers>

#include <gtest/gtest.h>

namespace fidservo::vision {
namespace {

const CameraGeometry camera{1280, 960, 5000.0, {639.5, 479.5}, 20.0};  // field 5.12 x 3.84 mm

/// Three rows, the middle one under the axis.
Plate grid() {
    Plate plate;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 10; ++column)
            plate.tags.push_back({row * 10 + column, {2.0 * column, 4.0 * (row - 1)}, 1.2});
    return plate;
}

std::vector<int> ids(const std::vector<PlateTag>& tags) {
    std::vector<int> found;
    for (const PlateTag& tag : tags) found.push_back(tag.id);
    return found;
}

TEST(TagChoice, Corners_AreInDetectionOrderAndTurnWithTheTag) {
    const auto corners = corners_mm({0, {4.0, 1.0}, 1.2});
    EXPECT_TRUE(corners[0].isApprox(Eigen::Vector2d(3.4, 1.6)));
    EXPECT_TRUE(corners[1].isApprox(Eigen::Vector2d(4.6, 1.6)));
    EXPECT_TRUE(corners[2].isApprox(Eigen::Vector2d(4.6, 0.4)));
    EXPECT_TRUE(corners[3].isApprox(Eigen::Vector2d(3.4, 0.4)));
    const auto turned = corners_mm({0, {4.0, 1.0}, 1.2, std::numbers::pi / 2});
    EXPECT_TRUE(turned[0].isApprox(corners[3]));
    EXPECT_TRUE(turned[1].isApprox(corners[0]));
}

TEST(TagChoice, BetweenTwoTags_BothAreInViewAndTheNearerOneIsFirst) {
    EXPECT_EQ(ids(visible_tags(camera, grid(), 4.9)), (std::vector<int>{12, 13}));
    EXPECT_EQ(ids(visible_tags(camera, grid(), 5.1)), (std::vector<int>{13, 12}));
    EXPECT_EQ(tag_to_use(camera, grid(), 5.1)->id, 13);
}

TEST(TagChoice, TieHalfway_GoesToTheLowerId) {
    EXPECT_EQ(tag_to_use(camera, grid(), 5.0)->id, 12);
}

TEST(TagChoice, QuietZone_MustBeInViewToo) {
    // Half field 2.56 mm, half tag with quiet zone 0.75 mm: in view within 1.81 mm of the axis.
    Plate one;
    one.tags.push_back({7, {10.0, 0.0}, 1.2});
    EXPECT_EQ(visible_tags(camera, one, 10.0 - 1.809).size(), 1U);
    EXPECT_EQ(visible_tags(camera, one, 10.0 - 1.811).size(), 0U);
    EXPECT_EQ(visible_tags(camera, one, 10.0 + 1.809).size(), 1U);
    EXPECT_FALSE(tag_to_use(camera, one, 10.0 + 1.811));
}

TEST(TagChoice, EveryPositionAlongTheRow_HasATag) {
    const Plate plate = grid();
    for (double s = 0.0; s <= 18.0; s += 0.01) EXPECT_TRUE(tag_to_use(camera, plate, s)) << s;
}

TEST(TagChoice, RowsBesideTheImage_AreOutOfReach) {
    const std::vector<int> reachable = ids(reachable_rows(camera, grid()));
    ASSERT_EQ(reachable.size(), 10U);
    EXPECT_EQ(reachable.front(), 10);
    EXPECT_EQ(reachable.back(), 19);
    EXPECT_TRUE(row_is_reachable(camera, {0, {0.0, 1.169}, 1.2}));  // 1.92 - 0.75
    EXPECT_FALSE(row_is_reachable(camera, {0, {0.0, 1.171}, 1.2}));
}

TEST(TagChoice, TurnedTag_NeedsMoreRoom) {
    EXPECT_FALSE(row_is_reachable(camera, {0, {0.0, 1.169}, 1.2, std::numbers::pi / 4}));
}

TEST(TagChoice, ViewRange_IsWhereTheTagIsVisible) {
    const PlateTag tag{3, {10.0, 0.5}, 1.2};
    const auto range = view_range(camera, tag);
    ASSERT_TRUE(range);
    EXPECT_NEAR(range->low_mm, 10.0 - 1.81, 1e-9);
    EXPECT_NEAR(range->high_mm, 10.0 + 1.81, 1e-9);
    EXPECT_FALSE(view_range(camera, {3, {10.0, 0.0}, 4.5}));
}

/// Turned by 1 degree, tilted by 3, distorting, on an axis that is 0.5 mrad oblique.
CameraGeometry camera_as_it_comes() {
    CameraGeometry general = camera;
    general.distortion.k1 = -0.2;
    general.rotation_rad = 0.0175;
    general.tilt_rad = {0.035, -0.039};
    general.axis_rad = {0.0005, 0.0};
    return general;
}

TEST(TagChoice, NearlyStraightCamera_HasTheStraightCamerasRange) {
    CameraGeometry nearly = camera;
    nearly.distortion.k1 = 1e-12;
    for (const double angle_rad : {0.0, 0.3}) {
        const PlateTag tag{3, {10.0, 0.5}, 1.2, angle_rad};
        const auto straight = view_range(camera, tag), general = view_range(nearly, tag);
        ASSERT_TRUE(straight && general);
        EXPECT_NEAR(general->low_mm, straight->low_mm, 1e-6);
        EXPECT_NEAR(general->high_mm, straight->high_mm, 1e-6);
    }
    EXPECT_TRUE(row_is_reachable(nearly, {0, {0.0, 1.169}, 1.2}));
    EXPECT_FALSE(row_is_reachable(nearly, {0, {0.0, 1.171}, 1.2}));
    EXPECT_EQ(ids(visible_tags(nearly, grid(), 4.9)), (std::vector<int>{12, 13}));
}

TEST(TagChoice, GeneralCamera_SeesTheTagToTheEndsOfItsRange) {
    const CameraGeometry general = camera_as_it_comes();
    Plate one;
    one.tags.push_back({7, {100.0, 0.0}, 1.2});
    const auto range = view_range(general, one.tags.front());
    ASSERT_TRUE(range);
    EXPECT_GT(range->high_mm - range->low_mm, 3.0);
    EXPECT_EQ(visible_tags(general, one, range->low_mm + 1e-6).size(), 1U);
    EXPECT_EQ(visible_tags(general, one, range->low_mm - 1e-6).size(), 0U);
    EXPECT_EQ(visible_tags(general, one, range->high_mm - 1e-6).size(), 1U);
    EXPECT_EQ(visible_tags(general, one, range->high_mm + 1e-6).size(), 0U);
    // At the end, a corner of the quiet zone is at the image's rim.
    const std::array<Eigen::Vector2d, 4> zone = corners_mm({7, {100.0, 0.0}, 1.5});
    double farthest_px = 0.0;
    for (const Eigen::Vector2d& corner : zone)
        farthest_px = std::max(farthest_px, project(general, corner, range->low_mm).x());
    EXPECT_NEAR(farthest_px, 1279.5, 1e-3);
}

TEST(TagChoice, ObliqueAxis_LosesTheRowWhereItDriftsOut) {
    CameraGeometry oblique = camera;
    oblique.axis_rad = {0.005, 0.0};  // 1 mm over 200
    EXPECT_TRUE(row_is_reachable(oblique, {0, {100.0, 1.169 + 0.5}, 1.2}));
    EXPECT_FALSE(row_is_reachable(oblique, {0, {10.0, 1.169 + 0.5}, 1.2}));
}

TEST(TagChoice, FindTag_KnowsWhatIsNotThere) {
    EXPECT_EQ(find_tag(grid(), 17)->id, 17);
    EXPECT_FALSE(find_tag(grid(), 30));
}

}  // namespace
}  // namespace fidservo::vision
