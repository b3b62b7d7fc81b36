// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/camera/camera_calibration.h"

#include "tests/calib/synthetic_target.h"
#include "tests/reference_camera.h"

#include <cmath>
#include <cstdio>
#include <numbers>

#include <gtest/gtest.h>

namespace fidservo::calib {
namespace {

constexpr double deg = std::numbers::pi / 180.0;

CameraGeometry bent_lens() {
    CameraGeometry lens = reference_camera().geometry;
    lens.focal_px = 5040.0;
    lens.principal_point_px = {645.0, 470.0};
    lens.distortion.k1 = -0.2;
    return lens;
}

/// Views from all around, tilted by up to 20 degrees, so that nearly every direction occurs.
std::vector<TargetView> tilted_views(const CameraGeometry& lens, int count, double most_tilt_rad,
                                     Scatter scatter, double std_px, std::uint64_t seed) {
    const std::vector<PlateTag> tags = tag_grid(25, 25, 0.75, 0.9375);
    NoiseStream noise(seed, "corners"), places(seed, "places");
    std::vector<TargetView> views;
    for (int k = 0; k < count; ++k) {
        CameraGeometry camera = lens;
        const double towards_rad = 2.4 * k;  // the golden angle
        const double tilt_rad = most_tilt_rad * std::sqrt((k + 0.5) / count);
        camera.tilt_rad = tilt_rad * Eigen::Vector2d(std::cos(towards_rad), std::sin(towards_rad));
        camera.rotation_rad = 1.0 * k;
        const Eigen::Vector2d foot = back_project(camera, camera.principal_point_px, 0.0);
        views.push_back(synthetic_view(camera, tags, places.uniform() - foot.x(), places.uniform() - foot.y(),
                                       scatter, std_px, noise));
    }
    return views;
}

CameraCalibrationOptions options_for(const CameraGeometry& lens) {
    CameraCalibrationOptions options;
    options.width_px = lens.width_px;
    options.height_px = lens.height_px;
    return options;
}

TEST(CameraCalibration, WithoutNoise_IsFoundExactly) {
    CameraGeometry lens = bent_lens();
    lens.focal_ratio = 1.002;
    lens.distortion = {.k1 = -0.25, .k2 = 0.8, .p1 = 2e-3, .p2 = -1e-3, .k3 = 0.0};
    CameraCalibrationOptions options = options_for(lens);
    options.fit_focal_ratio = true;
    const auto found =
        calibrate_camera(tilted_views(lens, 12, 20.0 * deg, Scatter::every_coordinate, 1e-6, 1), options);
    ASSERT_TRUE(found) << found.error().text;
    EXPECT_NEAR(found->camera.focal_px, lens.focal_px, 1e-3);
    EXPECT_NEAR(found->camera.focal_ratio, lens.focal_ratio, 1e-7);
    EXPECT_LT((found->camera.principal_point_px - lens.principal_point_px).norm(), 1e-2);
    EXPECT_NEAR(found->camera.distortion.k1, lens.distortion.k1, 1e-5);
    EXPECT_NEAR(found->camera.distortion.k2, lens.distortion.k2, 1e-3);
    EXPECT_NEAR(found->camera.distortion.p1, lens.distortion.p1, 1e-6);
    EXPECT_NEAR(found->camera.distortion.p2, lens.distortion.p2, 1e-6);
    EXPECT_LT(found->rms_px, 1e-5);
    EXPECT_EQ(found->unused, 0U);
}

/// The mean square of errors in standard deviations is 1 over many noise draws, whichever directions of the
/// corners were measured.
TEST(SlowCameraCalibration, StandardErrors_AreThoseOfManyNoises) {
    const CameraGeometry lens = bent_lens();
    constexpr int seeds = 16;
    for (const Scatter scatter : {Scatter::rigid, Scatter::every_coordinate}) {
        Eigen::Vector4d squares = Eigen::Vector4d::Zero();
        double misfit = 0.0, worst_focal = 0.0;
        for (int seed = 1; seed <= seeds; ++seed) {
            CameraCalibrationOptions options = options_for(lens);
            options.fitted = usual_lens();
            const auto found = calibrate_camera(
                tilted_views(lens, 12, 20.0 * deg, scatter, 0.01, static_cast<std::uint64_t>(seed)), options);
            ASSERT_TRUE(found) << "seed " << seed << ": " << found.error().text;
            const Eigen::Vector2d centre = found->camera.principal_point_px - lens.principal_point_px;
            const Eigen::Vector4d error(
                (found->camera.focal_px - lens.focal_px) / found->std_of(focal),
                centre.x() / found->std_of(centre_u), centre.y() / found->std_of(centre_v),
                (found->camera.distortion.k1 - lens.distortion.k1) / found->std_of(k1));
            squares += error.cwiseAbs2() / seeds;
            misfit += found->misfit / seeds;
            worst_focal = std::max(worst_focal, std::abs(found->camera.focal_px / lens.focal_px - 1.0));
        }
        std::printf(
            "mean squares of (f, u0, v0, k1) in their variances: %.2f %.2f %.2f %.2f; misfit %.3f; "
            "worst focal length %.4f %%\n",
            squares(0), squares(1), squares(2), squares(3), misfit, 100.0 * worst_focal);
        for (const double square : squares) EXPECT_NEAR(square, 1.0, 4.0 * std::sqrt(2.0 / seeds));
        EXPECT_NEAR(misfit, 1.0, 0.02);
    }
}

/// As for a hand-held AprilGrid in front of a wide-angle lens.
TEST(CameraCalibration, WideLens_IsFoundFromNothing) {
    CameraGeometry lens{752, 480, 458.0, {367.0, 248.0}, 500.0};
    lens.distortion = {.k1 = -0.283, .k2 = 0.074, .p1 = 2e-4, .p2 = 2e-5, .k3 = 0.0};
    const std::vector<PlateTag> tags = tag_grid(6, 6, 88.0, 114.4);
    NoiseStream noise(1, "corners"), places(1, "places");
    std::vector<TargetView> views;
    for (int k = 0; k < 20; ++k) {
        CameraGeometry camera = lens;
        camera.tilt_rad = 0.6 * Eigen::Vector2d(std::cos(2.4 * k), std::sin(2.4 * k));
        camera.distance_mm = 500.0 + 600.0 * places.uniform();
        const Eigen::Vector2d foot = back_project(camera, camera.principal_point_px, 0.0);
        views.push_back(synthetic_view(camera, tags, 300.0 * places.uniform() - 150.0 - foot.x(),
                                       200.0 * places.uniform() - 100.0 - foot.y(), Scatter::every_coordinate,
                                       0.1, noise));
        if (views.back().tags.size() < 2) views.pop_back();
    }
    const auto found = calibrate_camera(views, options_for(lens));
    ASSERT_TRUE(found) << found.error().text;
    EXPECT_LT(std::abs(found->camera.focal_px - lens.focal_px), 4.0 * found->std_of(focal));
    EXPECT_LT(std::abs(found->camera.distortion.k1 - lens.distortion.k1), 4.0 * found->std_of(k1));
    EXPECT_LT(found->std_of(focal), 1.0);
    EXPECT_TRUE(found->fitted[k2]);
    EXPECT_NEAR(found->rms_px, 0.1 * std::sqrt(2.0), 0.01);
    EXPECT_EQ(found->unused, 0U);
}

TEST(SlowCameraCalibration, TermsThatAreNotThere_AreNotFitted) {
    const CameraGeometry lens = bent_lens();
    int extra = 0;
    constexpr int seeds = 10;
    for (int seed = 1; seed <= seeds; ++seed) {
        const auto found = calibrate_camera(
            tilted_views(lens, 12, 20.0 * deg, Scatter::rigid, 0.01, static_cast<std::uint64_t>(seed)),
            options_for(lens));
        ASSERT_TRUE(found) << found.error().text;
        extra += found->fitted == usual_lens() ? 0 : 1;
    }
    EXPECT_LE(extra, 2);  // three tests at 1 % each: 0.3 expected in ten
}

TEST(CameraCalibration, WronglyReadTag_IsLeftOut) {
    const CameraGeometry lens = bent_lens();
    std::vector<TargetView> views = tilted_views(lens, 12, 20.0 * deg, Scatter::rigid, 0.01, 3);
    views[4].tags[2].printed.centre_mm.x() += 0.05;
    const auto found = calibrate_camera(views, options_for(lens));
    ASSERT_TRUE(found) << found.error().text;
    EXPECT_EQ(found->unused, 1U);
    EXPECT_FALSE(found->views[4].tags[2].used);
    EXPECT_LT(std::abs(found->camera.focal_px - lens.focal_px), 5.0 * found->std_of(focal));
}

TEST(CameraCalibration, ParallelViews_DoNotTellTheFocalLength) {
    const CameraGeometry lens = bent_lens();
    const auto found =
        calibrate_camera(tilted_views(lens, 12, 0.0, Scatter::rigid, 0.01, 1), options_for(lens));
    if (found) {
        EXPECT_GT(found->std_of(focal), 0.02 * found->camera.focal_px);
    }
}

TEST(CameraCalibration, TooFewViews_AreRefused) {
    const CameraGeometry lens = bent_lens();
    EXPECT_FALSE(calibrate_camera({}, options_for(lens)));
    EXPECT_FALSE(calibrate_camera({TargetView{}}, options_for(lens)));
}

}  // namespace
}  // namespace fidservo::calib
