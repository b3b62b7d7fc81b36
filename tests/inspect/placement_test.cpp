// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/inspect/recipe/placement.h"

#include "core/failure.h"
#include "core/result.h"
#include "core/rig.h"
#include "core/units.h"
#include "tests/inspect/small_recipe.h"
#include "vision/features/verdict.h"

#include <gtest/gtest.h>

namespace fidservo::inspect {
namespace {

constexpr double corner_std_px = 0.01;

Plate plate_of_three() {
    Plate plate;
    for (int id = 0; id < 3; ++id) plate.tags.push_back({id, {2.0 * id, 0.0}, 1.2});
    return plate;
}

/// Two views, between tags 0 and 1 and between tags 1 and 2, of a plate with displaced tags; the camera's
/// scale is wrong by the fraction `scale_error`.
std::vector<Snapshot> views_of(const std::array<Eigen::Vector2d, 3>& displaced_um, double scale_error = 0.0) {
    const Plate plate = plate_of_three();
    const CameraParameters camera = *small_rig().camera;
    std::vector<Snapshot> snapshots;
    for (const int first : {0, 1}) {
        Snapshot snapshot{{{}, camera, {2.0 * first + 1.0, 0.0}, {0.0, 0.0}}, {}};
        for (const int id : {first, first + 1}) {
            TagDetection tag;
            tag.tag_id = id;
            const Eigen::Vector2d centre_mm = plate.tags[id].centre_mm + displaced_um[id] / um_per_mm;
            int k = 0;
            for (const auto& [x, y] :
                 {std::pair(-0.6, 0.6), std::pair(0.6, 0.6), std::pair(0.6, -0.6), std::pair(-0.6, -0.6)}) {
                const Eigen::Vector2d at_px =
                    project(camera.geometry, centre_mm + Eigen::Vector2d(x, y), snapshot.image.axis_mm.x());
                tag.corners_px[k++] = camera.geometry.principal_point_px +
                                      (1.0 + scale_error) * (at_px - camera.geometry.principal_point_px);
            }
            snapshot.tags.push_back(vision::tag_of_corners(
                tag, vision::CornerCovariance::Identity() * corner_std_px * corner_std_px));
        }
        snapshots.push_back(snapshot);
    }
    return snapshots;
}

TEST(Placement, MiddleTagDisplaced_IsMeasured) {
    const auto placement = measure_placement(views_of({{{0, 0}, {30, -20}, {0, 0}}}), plate_of_three(), 1);
    ASSERT_TRUE(placement);
    EXPECT_NEAR(placement->x_um.value, 30.0, 1e-9);
    EXPECT_NEAR(placement->y_um.value, -20.0, 1e-9);
    EXPECT_EQ(placement->neighbours, (std::vector<int>{0, 2}));
    EXPECT_EQ(vision::decide(placement->x_um, 0.0, 10.0), vision::Verdict::fail);
}

TEST(Placement, Uncertainty_IsThatOfTheCornersCentres) {
    const auto placement = measure_placement(views_of({{{0, 0}, {0, 0}, {0, 0}}}), plate_of_three(), 1);
    ASSERT_TRUE(placement);
    // A centre is the mean of four corners: std / 2. A difference of two: times sqrt(2). The mean of two:
    // over sqrt(2).
    EXPECT_NEAR(placement->x_um.std, 4.0 * corner_std_px / 2.0, 1e-9);
}

TEST(Placement, NeighbourDisplaced_IsUndecidableNotWrong) {
    const auto placement = measure_placement(views_of({{{30, 0}, {0, 0}, {0, 0}}}), plate_of_three(), 1);
    ASSERT_TRUE(placement);
    EXPECT_NEAR(placement->disagreement_um.x(), 30.0, 1e-9);
    EXPECT_EQ(vision::decide(placement->x_um, 0.0, 10.0), vision::Verdict::not_decidable);
}

TEST(Placement, ScaleError_CancelsBetweenBothSides) {
    const auto placement =
        measure_placement(views_of({{{0, 0}, {5, 0}, {0, 0}}}, 0.002), plate_of_three(), 1);
    ASSERT_TRUE(placement);
    EXPECT_NEAR(placement->x_um.value, 5.0, 0.02);
    EXPECT_GT(placement->disagreement_um.x(), 7.0);
}

TEST(Placement, ScaleUnknown_CountsWhereOneSideIsSeen) {
    constexpr double scale_std = 1e-3;
    std::vector<Snapshot> snapshots = views_of({{{0, 0}, {0, 0}, {0, 0}}});
    for (Snapshot& snapshot : snapshots)
        snapshot.image.camera.geometry_covariance(camera_distance, camera_distance) =
            std::pow(scale_std * snapshot.image.camera.geometry.distance_mm, 2.0);
    const auto both_sides = measure_placement(snapshots, plate_of_three(), 1);
    const auto one_side = measure_placement(snapshots, plate_of_three(), 0);
    ASSERT_TRUE(both_sides && one_side);
    EXPECT_LT(both_sides->x_um.std, 0.03);
    EXPECT_NEAR(one_side->x_um.std, 2000.0 * scale_std, 0.03);
    EXPECT_LT(one_side->y_um.std, 0.06);
}

TEST(Placement, NoNeighbourInView_Fails) {
    auto snapshots = views_of({{{0, 0}, {0, 0}, {0, 0}}});
    for (Snapshot& snapshot : snapshots)
        std::erase_if(snapshot.tags, [](const auto& tag) { return tag.detection.tag_id != 1; });
    const auto placement = measure_placement(snapshots, plate_of_three(), 1);
    ASSERT_FALSE(placement);
    EXPECT_EQ(placement.error().reason, Reason::no_tag);
}

}  // namespace
}  // namespace fidservo::inspect
