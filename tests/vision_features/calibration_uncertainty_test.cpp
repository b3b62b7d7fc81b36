// SPDX-License-Identifier: GPL-3.0-or-later
// What is measured with a camera that is a little other than its calibration says.
#include "core/random.h"
#include "core/units.h"
#include "tests/vision_features/consistency.h"
#include "tests/vision_features/scene.h"
#include "vision/features/edge_distance.h"
#include "vision/features/line.h"
#include "vision/features/mark.h"
#include "vision/features/pad.h"

#include <Eigen/Cholesky>

namespace fidservo::vision::testing {
namespace {

/// Much larger than the uncertainty after a calibration, so that it dominates the uncertainties here.
CameraCovariance loose_calibration() {
    const CameraNumbers std{{0.02, 1e-3, 2e-3, 2e-3, 1e-3, 1e-3, 0.02}};
    CameraCovariance correlation = CameraCovariance::Identity();
    correlation(camera_distance, camera_k1) = correlation(camera_k1, camera_distance) = -0.7;
    correlation(camera_tilt_u, camera_rotation) = correlation(camera_rotation, camera_tilt_u) = 0.4;
    return std.asDiagonal() * correlation * std.asDiagonal();
}

/// The image, read with a camera drawn from that covariance about the true one, its position told by a
/// fiducial at `anchor_mm`.
RestImage read_with_another_camera(RestImage image, const Eigen::Vector2d& anchor_mm, NoiseStream& draws) {
    image.anchor_px = to_image(image, anchor_mm);
    const CameraCovariance covariance = loose_calibration();
    CameraNumbers white;
    for (int k = 0; k < camera_numbers; ++k) white(k) = draws.normal();
    CameraGeometry& camera = image.camera.geometry;
    camera = with_numbers(camera, numbers_of(camera) + covariance.llt().matrixL() * white);
    image.camera.geometry_covariance = covariance;
    const Eigen::Vector2d missed = anchor_mm - to_plate(image, image.anchor_px);
    image.axis_mm += missed;
    return image;
}

TEST(SlowCalibrationUncertainty, PlacesAndSizes_AreAsFarOffAsStated) {
    constexpr int draws = 150;
    constexpr std::uint64_t seed = 20261122;
    RecordProperty("seed", std::to_string(seed));
    Scene scene = scene_of(1280, 960);
    const Eigen::Vector2d foot(scene.s_mm, 0.0);
    const Dot dot{foot + Eigen::Vector2d(1.8, -0.9), 0.4};
    const Pad pad{foot + Eigen::Vector2d(-0.6, 1.2), {0.9, 0.4}, 0.2};
    const Line line{foot + Eigen::Vector2d(0.4, 0.6), foot + Eigen::Vector2d(2.0, 1.4), 0.06};
    scene.print(dot);
    scene.print(pad);
    scene.print(line);
    const RestImage image = take(scene, 1);
    NoiseStream random(seed, "calibration");
    Consistency dot_x, dot_y, diameter, pad_x, pad_y, width, height, offset;
    for (int i = 0; i < draws; ++i) {
        const RestImage read = read_with_another_camera(image, foot + Eigen::Vector2d(-1.5, -0.8), random);
        const auto seen_dot = measure_dot(read, dot, {});
        const auto seen_pad = measure_pad(read, pad, {});
        const auto seen_line = measure_line(read, line, {});
        ASSERT_TRUE(seen_dot && seen_pad && seen_line) << "draw " << i;
        dot_x.add(seen_dot->x_um, um_from_mm(dot.centre_mm.x()));
        dot_y.add(seen_dot->y_um, um_from_mm(dot.centre_mm.y()));
        diameter.add(seen_dot->diameter_um, um_from_mm(dot.diameter_mm));
        pad_x.add(seen_pad->x_um, um_from_mm(pad.centre_mm.x()));
        pad_y.add(seen_pad->y_um, um_from_mm(pad.centre_mm.y()));
        width.add(seen_pad->width_um, um_from_mm(pad.size_mm.x()));
        height.add(seen_pad->height_um, um_from_mm(pad.size_mm.y()));
        offset.add(seen_line->offset_um, 0.0);
    }
    constexpr double most_bias_um = 1.0;
    expect_consistent(dot_x, most_bias_um, "dot x");
    expect_consistent(dot_y, most_bias_um, "dot y");
    expect_consistent(diameter, most_bias_um, "diameter");
    expect_consistent(pad_x, most_bias_um, "pad x");
    expect_consistent(pad_y, most_bias_um, "pad y");
    expect_consistent(width, most_bias_um, "width");
    expect_consistent(height, most_bias_um, "height");
    expect_consistent(offset, most_bias_um, "line's offset");
}

TEST(CalibrationUncertainty, EdgeDistance_CountsTheScale) {
    Scene scene = scene_of(1280, 960);
    const Eigen::Vector2d foot(scene.s_mm, 0.0);
    const Pad left{foot - Eigen::Vector2d(1.0, 0.0), {0.5, 0.8}, 0.0},
        right{foot + Eigen::Vector2d(1.0, 0.0), {0.5, 0.8}, 0.0};
    scene.print(left);
    scene.print(right);
    RestImage image = take(scene, 2);
    const auto edges = facing_edges(edges_of(left), edges_of(right));
    ASSERT_TRUE(edges);
    const auto exact = measure_edge_distance(image, edges->first, edges->second, {});
    constexpr double scale_std = 1e-3;
    image.camera.geometry_covariance(camera_distance, camera_distance) =
        std::pow(scale_std * image.camera.geometry.distance_mm, 2.0);
    const auto unsure = measure_edge_distance(image, edges->first, edges->second, {});
    ASSERT_TRUE(exact && unsure);
    EXPECT_NEAR(unsure->distance_um.std, std::hypot(exact->distance_um.std, 1500.0 * scale_std), 1e-3);
}

}  // namespace
}  // namespace fidservo::vision::testing
