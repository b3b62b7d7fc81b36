// SPDX-License-Identifier: GPL-3.0-or-later
#include "reference/camera_view.h"

#include "core/rig.h"
#include "plant/actual_camera.h"
#include "tests/reference_rig.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace fidservo::reference {
namespace {

TEST(Camera, Departures_MoveImagePointsAsAPinholeDoes) {
    CameraModel model{*reference_rig().camera, *reference_rig().fiducials, {}};
    EXPECT_TRUE(image_of(model, {1.0, 0.5}, 0.6).isApprox(Eigen::Vector2d(739.5, 604.5), 1e-12));
    model.departures = {.scale = 1.02, .rotation_rad = std::numbers::pi / 2};
    EXPECT_TRUE(image_of(model, {1.0, 0.5}, 0.6).isApprox(Eigen::Vector2d(512.0, 581.5), 1e-12));
    model.departures = {.tilt_rad = 0.1, .tilt_axis_rad = std::numbers::pi / 2};
    const double depth = 20.0 + 0.4 * std::sin(0.1);
    EXPECT_NEAR(image_of(model, {1.0, 0.5}, 0.6).x(), 639.5 + 5000.0 * 0.4 * std::cos(0.1) / depth, 1e-9);
    EXPECT_NEAR(image_of(model, {1.0, 0.5}, 0.6).y(), 479.5 + 5000.0 * 0.5 / depth, 1e-9);
    model.departures = {.aspect = 1.01};
    EXPECT_TRUE(image_of(model, {1.0, 0.5}, 0.6).isApprox(Eigen::Vector2d(739.5, 605.75), 1e-12));
    model.departures = {.distortion = 2.0};
    EXPECT_NEAR(image_of(model, {2.0, 0.0}, 0.0).x(), 639.5 + 500.0 * 1.02, 1e-9);
}

TEST(Camera, TiltAboutItself_MovesWhatItLooksAt) {
    CameraModel model{*reference_rig().camera, *reference_rig().fiducials, {}};
    model.departures = {.tilt_rad = 0.02, .tilt_axis_rad = 0.0, .tilt_height = 1.0};
    const Eigen::Vector2d seen = image_of(model, {50.0, 0.0}, 50.0);
    EXPECT_NEAR(seen.x(), 639.5, 1e-9);
    EXPECT_NEAR(seen.y(), 479.5 + 5000.0 * std::tan(0.02), 1e-9);
}

TEST(Camera, Tilt_IsThatOfThePlantsCamera) {
    CameraModel model{*reference_rig().camera, *reference_rig().fiducials, {}};
    NoiseStream draw(7, "tilts");
    const auto within = [&](double low, double high) { return low + (high - low) * draw.uniform(); };
    for (int k = 0; k < 200; ++k) {
        const double tilt_rad = within(-0.05, 0.05), axis_rad = within(-3.0, 3.0), height = draw.uniform();
        model.departures = {.tilt_rad = tilt_rad, .tilt_axis_rad = axis_rad, .tilt_height = height};
        const Eigen::Vector2d axis(std::cos(axis_rad), std::sin(axis_rad));
        const plant::CameraDeviation deviation{.tilt_rad = -tilt_rad * axis, .tilt_axis_height = height};
        const Eigen::Vector2d plate_mm(within(47.0, 53.0), within(-2.0, 2.0));
        const Eigen::Vector2d seen =
            plant::actual_camera(model.camera.geometry, deviation).image_px(plate_mm, 50.0);
        EXPECT_NEAR((image_of(model, plate_mm, 50.0) - seen).norm(), 0.0, 1e-8) << "seed 7, case " << k;
    }
}

TEST(Camera, BarrelLens_ShowsTheTagInFrontOfIt) {
    // x (1 - 0.0392 x^2) comes back to the axis at x = -5.05: there stands tag 0.
    CameraModel model{*reference_rig().camera, *reference_rig().fiducials, {.distortion = -0.0392}};
    model.camera.corner_noise_px = 0.0;
    NoiseStream noise(1, "corners");
    const auto seen = see(model, 100.9, 0.0, noise);
    ASSERT_TRUE(seen);
    EXPECT_EQ(seen->tag_id, 50);
}

}  // namespace
}  // namespace fidservo::reference
