// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/stage/camera_mount.h"

#include "calib/camera/lens_projection.h"
#include "calib/camera/plane_pose.h"
#include "core/failure.h"
#include "core/result.h"
#include "tests/calib/synthetic_target.h"
#include "tests/reference_camera.h"

#include <cmath>

#include <gtest/gtest.h>

namespace fidservo::calib {
namespace {

CameraGeometry mounted_camera() {
    CameraGeometry camera = reference_camera().geometry;
    camera.focal_ratio = 1.001;
    camera.distortion = {.k1 = -0.2, .k2 = 0.5, .p1 = 1e-3, .p2 = -2e-3, .k3 = 0.0};
    camera.rotation_rad = 0.03;
    camera.tilt_rad = {0.02, -0.05};
    camera.distance_mm = 20.4;
    camera.axis_rad = {0.004, -0.002};
    return camera;
}

/// The lens of a camera; the mount that a rig file might state.
CameraGeometry lens_of_camera(CameraGeometry camera) {
    camera.rotation_rad = 0.0;
    camera.tilt_rad.setZero();
    camera.distance_mm = 20.0;
    return camera;
}

TEST(LensProjection, Template_IsCoresProjection) {
    const CameraGeometry camera = mounted_camera();
    const Lens lens = lens_of(camera);
    for (const Eigen::Vector2d& plate_mm : {Eigen::Vector2d(0.0, 0.0), {2.1, 1.5}, {-2.3, 1.1}}) {
        const Eigen::Vector3d seen =
            camera_from_plate(camera) * Eigen::Vector3d(plate_mm.x(), plate_mm.y(), camera.distance_mm);
        EXPECT_LT(
            (image_of(camera.distortion.model, lens.data(), seen) - project(camera, plate_mm, 0.0)).norm(),
            1e-9);
    }
    CameraGeometry copy = lens_of_camera(reference_camera().geometry);
    set_lens(copy, lens);
    EXPECT_EQ(lens_of(copy), lens);
}

TEST(PlanePose, OfAnyCamera_ComesBackFromItsPicture) {
    const CameraGeometry camera = mounted_camera();
    NoiseStream noise(1, "none");
    const TargetView view =
        synthetic_view(camera, tag_grid(9, 7, 0.6, 0.8), 0.3, -0.2, Scatter::every_coordinate, 1e-9, noise);
    const CameraGeometry lens = lens_of_camera(camera);
    const auto homography = target_homography(lens, view);
    ASSERT_TRUE(homography);
    const PlanePose pose = pose_of_homography(lens, *homography);
    const CameraGeometry found = camera_at(lens, pose);
    EXPECT_NEAR(found.rotation_rad, camera.rotation_rad, 1e-8);
    EXPECT_LT((found.tilt_rad - camera.tilt_rad).norm(), 1e-7);
    const double axis_length = Eigen::Vector3d(1.0, 0.004, -0.002).norm();
    EXPECT_NEAR(found.distance_mm, camera.distance_mm + 0.3 * 0.002 / axis_length, 1e-6);
    EXPECT_NEAR(pose.centre_mm().x(), 0.3 / axis_length, 1e-6);
    EXPECT_NEAR(pose.centre_mm().y(), -0.2 + 0.3 * 0.004 / axis_length, 1e-6);
}

TEST(CameraMount, WithoutNoise_IsFoundExactly) {
    const CameraGeometry camera = mounted_camera();
    NoiseStream noise(1, "none");
    std::vector<TargetView> views;
    for (const double s_mm : {-1.0, 0.2, 1.5})
        views.push_back(
            synthetic_view(camera, tag_grid(9, 7, 0.6, 0.8), s_mm, 0.1 * s_mm, Scatter::rigid, 1e-7, noise));
    const auto mount = fit_camera_mount(lens_of_camera(camera), views);
    ASSERT_TRUE(mount) << mount.error().text;
    EXPECT_NEAR(mount->camera.rotation_rad, camera.rotation_rad, 1e-9);
    EXPECT_LT((mount->camera.tilt_rad - camera.tilt_rad).norm(), 1e-8);
    EXPECT_NEAR(mount->camera.distance_mm, camera.distance_mm, 1e-6);
    EXPECT_NEAR(mount->views[2].s_mm, 1.5, 1e-7);
    EXPECT_NEAR(mount->views[2].y_mm, 0.15, 1e-7);
    EXPECT_LT(mount->rms_px, 1e-6);
}

/// Errors over their standard deviations, mean square over many seeds: 1.
TEST(CameraMount, StandardErrors_AreThoseOfManyNoises) {
    const CameraGeometry camera = mounted_camera();
    constexpr int seeds = 60;
    for (const Scatter scatter : {Scatter::rigid, Scatter::every_coordinate}) {
        Eigen::Matrix<double, 5, 1> squares = Eigen::Matrix<double, 5, 1>::Zero();
        double misfit = 0.0;
        for (int seed = 1; seed <= seeds; ++seed) {
            NoiseStream noise(static_cast<std::uint64_t>(seed), "corners");
            std::vector<TargetView> views;
            for (const double s_mm : {-0.7, 0.6})
                views.push_back(
                    synthetic_view(camera, tag_grid(7, 7, 1.2, 1.6), s_mm, 0.0, scatter, 0.01, noise));
            const auto mount = fit_camera_mount(lens_of_camera(camera), views);
            ASSERT_TRUE(mount) << "seed " << seed << ": " << mount.error().text;
            Eigen::Matrix<double, 5, 1> error;
            error << mount->camera.rotation_rad - camera.rotation_rad,
                mount->camera.tilt_rad - camera.tilt_rad, mount->camera.distance_mm - camera.distance_mm,
                (mount->views[0].s_mm + 0.7) / mount->views[0].s_std_mm;
            error.head<4>().array() /= mount->covariance.diagonal().array().sqrt();
            squares += error.cwiseAbs2() / seeds;
            misfit += mount->misfit / seeds;
        }
        // Mean squares of 60 unit normals scatter by sqrt(2 / 60) = 0.18; the misfit that widens them adds
        // little.
        for (const double square : squares) EXPECT_NEAR(square, 1.0, 4.0 * std::sqrt(2.0 / seeds));
        EXPECT_NEAR(misfit, 1.0, 0.1);
    }
}

TEST(CameraMount, OneTagInEveryView_IsRefused) {
    NoiseStream noise(1, "none");
    const auto mount = fit_camera_mount(
        reference_camera().geometry,
        {synthetic_view(mounted_camera(), tag_grid(1, 1, 1.2, 2.0), 0.0, 0.0, Scatter::rigid, 0.01, noise)});
    ASSERT_FALSE(mount);
    EXPECT_EQ(mount.error().reason, Reason::not_identifiable);
    EXPECT_FALSE(fit_camera_mount(reference_camera().geometry, {}));
    EXPECT_FALSE(fit_camera_mount(reference_camera().geometry, {TargetView{}}));
}

}  // namespace
}  // namespace fidservo::calib
