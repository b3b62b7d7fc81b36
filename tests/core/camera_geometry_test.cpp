// SPDX-License-Identifier: GPL-3.0-or-later
// Projection and its inverse, for cameras with every parameter off its neutral value.
#include "core/camera/camera_geometry.h"

#include "core/camera/camera_slopes.h"
#include "core/random.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace fidservo {
namespace {

constexpr std::uint64_t seed = 11;

CameraGeometry straight_camera() {
    return {1280, 960, 5000.0, {639.5, 479.5}, 20.0};
}

double between(NoiseStream& random, double low, double high) {
    return low + (high - low) * random.uniform();
}

/// Every parameter at random, within what a lens that is screwed on by hand may have.
CameraGeometry some_camera(NoiseStream& random) {
    CameraGeometry camera = straight_camera();
    camera.focal_px = between(random, 1500.0, 6000.0);
    camera.principal_point_px += Eigen::Vector2d(between(random, -40, 40), between(random, -40, 40));
    camera.focal_ratio = between(random, 0.97, 1.03);
    camera.distortion = {.k1 = between(random, -0.25, 0.25),
                         .k2 = between(random, -0.2, 0.2),
                         .p1 = between(random, -0.005, 0.005),
                         .p2 = between(random, -0.005, 0.005),
                         .k3 = between(random, -0.1, 0.1)};
    camera.rotation_rad = between(random, -std::numbers::pi, std::numbers::pi);
    camera.tilt_rad = {between(random, -0.1, 0.1), between(random, -0.1, 0.1)};
    camera.axis_rad = {between(random, -0.002, 0.002), between(random, -0.002, 0.002)};
    return camera;
}

Eigen::Vector2d some_pixel(NoiseStream& random) {
    return {between(random, -0.5, 1279.5), between(random, -0.5, 959.5)};
}

TEST(CameraGeometry, AnyCamera_PixelToPlateAndBackIsTheSamePixel) {
    NoiseStream random(seed, "camera_geometry_test");
    double worst_px = 0.0;
    for (int k = 0; k < 2000; ++k) {
        const CameraGeometry camera = some_camera(random);
        ASSERT_TRUE(lens_is_one_to_one(camera)) << "seed " << seed << ", case " << k;
        const Eigen::Vector2d pixel = some_pixel(random);
        const double s_mm = between(random, 0.0, 200.0);
        const Eigen::Vector2d again = project(camera, back_project(camera, pixel, s_mm), s_mm);
        worst_px = std::max(worst_px, (again - pixel).norm());
        EXPECT_LT((again - pixel).norm(), 1e-9) << "seed " << seed << ", case " << k;
    }
    RecordProperty("worst_px", std::to_string(worst_px));
}

TEST(CameraGeometry, AnyLens_UndistortIsTheInverseOfDistort) {
    NoiseStream random(seed, "lens_test");
    for (int k = 0; k < 2000; ++k) {
        const LensDistortion lens = some_camera(random).distortion;
        const Eigen::Vector2d ideal(between(random, -0.4, 0.4), between(random, -0.3, 0.3));
        EXPECT_LT((undistort(lens, distort(lens, ideal)) - ideal).norm(), 1e-14)
            << "seed " << seed << ", case " << k;
    }
}

TEST(CameraGeometry, StraightCamera_IsThePinholeBitForBit) {
    NoiseStream random(seed, "straight_camera_test");
    const CameraGeometry camera = straight_camera();
    const double scale = 20.0 / 5000.0;
    const auto same_bits = [](double a, double b) {
        return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
    };
    for (int k = 0; k < 2000; ++k) {
        const Eigen::Vector2d plate(between(random, 0.0, 200.0), between(random, -2.0, 2.0));
        const Eigen::Vector2d pixel = some_pixel(random);
        const double s_mm = between(random, 0.0, 200.0);
        const Eigen::Vector2d seen = project(camera, plate, s_mm);
        EXPECT_TRUE(same_bits(seen.x(), 639.5 + (plate.x() - s_mm) / scale)) << "seed " << seed;
        EXPECT_TRUE(same_bits(seen.y(), 479.5 + (plate.y() - 0.0) / scale)) << "seed " << seed;
        const Eigen::Vector2d back = back_project(camera, pixel, s_mm);
        EXPECT_TRUE(same_bits(back.x(), (pixel.x() - 639.5) * scale + s_mm)) << "seed " << seed;
        EXPECT_TRUE(same_bits(back.y(), (pixel.y() - 479.5) * scale + 0.0)) << "seed " << seed;
    }
}

TEST(CameraGeometry, AnyOneParameter_MakesACameraThatDoesNotLookStraight) {
    EXPECT_TRUE(looks_straight(straight_camera()));
    const auto looks_straight_with = [](auto change) {
        CameraGeometry camera = straight_camera();
        change(camera);
        return looks_straight(camera);
    };
    EXPECT_FALSE(looks_straight_with([](CameraGeometry& c) { c.focal_ratio = 1.001; }));
    EXPECT_FALSE(looks_straight_with([](CameraGeometry& c) { c.distortion.k1 = 1e-9; }));
    EXPECT_FALSE(looks_straight_with([](CameraGeometry& c) { c.distortion.k2 = 1e-9; }));
    EXPECT_FALSE(looks_straight_with([](CameraGeometry& c) { c.distortion.p1 = 1e-9; }));
    EXPECT_FALSE(looks_straight_with([](CameraGeometry& c) { c.distortion.p2 = 1e-9; }));
    EXPECT_FALSE(looks_straight_with([](CameraGeometry& c) { c.distortion.k3 = 1e-9; }));
    EXPECT_FALSE(looks_straight_with([](CameraGeometry& c) { c.rotation_rad = 1e-9; }));
    EXPECT_FALSE(looks_straight_with([](CameraGeometry& c) { c.tilt_rad.y() = 1e-9; }));
    EXPECT_FALSE(looks_straight_with([](CameraGeometry& c) { c.axis_rad.x() = 1e-9; }));
}

TEST(CameraGeometry, NearlyStraightCamera_AgreesWithTheStraightFormulas) {
    // The general formulas against the special ones: a parameter of 1e-13 changes nothing that can be seen.
    CameraGeometry nearly = straight_camera();
    nearly.distortion.k1 = 1e-13;
    const Eigen::Vector2d plate(101.3, 0.7);
    EXPECT_LT((project(nearly, plate, 100.0) - project(straight_camera(), plate, 100.0)).norm(), 1e-9);
    EXPECT_LT(
        (back_project(nearly, {1100, 60}, 3.0) - back_project(straight_camera(), {1100, 60}, 3.0)).norm(),
        1e-12);
}

TEST(CameraGeometry, Rotation_TurnsPlateXFromUTowardsV) {
    CameraGeometry camera = straight_camera();
    camera.rotation_rad = 0.5 * std::numbers::pi;
    EXPECT_LT((project(camera, {0.4, 0.0}, 0.0) - Eigen::Vector2d(639.5, 579.5)).norm(), 1e-9);
}

TEST(CameraGeometry, FocalRatio_StretchesTheImageInV) {
    CameraGeometry camera = straight_camera();
    camera.focal_ratio = 1.02;
    EXPECT_LT((project(camera, {0.4, 0.4}, 0.0) - Eigen::Vector2d(739.5, 581.5)).norm(), 1e-9);
}

TEST(CameraGeometry, TiltAboutU_LooksAsideInV) {
    // The camera turned about u by t sees the foot of its perpendicular where tan(t) says.
    CameraGeometry camera = straight_camera();
    camera.tilt_rad = {0.03, 0.0};
    EXPECT_LT(
        (project(camera, {7.0, 0.0}, 7.0) - Eigen::Vector2d(639.5, 479.5 - 5000 * std::tan(0.03))).norm(),
        1e-9);
}

TEST(CameraGeometry, ObliqueAxis_DriftsOverTheTravel) {
    // 0.5 mrad towards y over 100 mm: the plate point that stays below the stage's x moves 50 um up; towards
    // the plate, the image grows as the distance shrinks.
    CameraGeometry camera = straight_camera();
    camera.axis_rad = {0.0005, 0.001};
    const double length = std::sqrt(1.0 + 0.0005 * 0.0005 + 0.001 * 0.001);
    const Eigen::Vector2d seen = project(camera, {100.0 / length, 0.0}, 100.0);
    EXPECT_LT((seen - Eigen::Vector2d(639.5, 479.5 - 5000 * 0.05 / length / (20.0 - 0.1 / length))).norm(),
              1e-9);
}

TEST(CameraGeometry, PlateByImage_IsTheSlopeOfBackProject) {
    NoiseStream random(seed, "plate_by_image_test");
    for (int k = 0; k < 200; ++k) {
        const CameraGeometry camera = some_camera(random);
        const Eigen::Vector2d pixel = some_pixel(random);
        const double s_mm = between(random, 0.0, 200.0);
        const Eigen::Matrix2d slope = plate_by_image(camera, pixel, s_mm);
        constexpr double step_px = 0.01;
        for (int axis = 0; axis < 2; ++axis) {
            const Eigen::Vector2d step = step_px * Eigen::Vector2d::Unit(axis);
            const Eigen::Vector2d difference =
                (back_project(camera, pixel + step, s_mm) - back_project(camera, pixel - step, s_mm)) /
                (2 * step_px);
            EXPECT_LT((slope.col(axis) - difference).norm(), 1e-6 * slope.norm())
                << "seed " << seed << ", case " << k;
        }
        EXPECT_NEAR(mm_per_px_at(camera, pixel, s_mm), std::sqrt(slope.determinant()), 1e-12);
    }
    EXPECT_EQ(mm_per_px_at(straight_camera(), {3, 4}, 5.0), 0.004);
}

TEST(CameraGeometry, IdealPoint_IsTheDirectionAndItsSlope) {
    NoiseStream random(seed, "ideal_point_test");
    for (int k = 0; k < 200; ++k) {
        const CameraGeometry camera = some_camera(random);
        const Eigen::Vector2d pixel = some_pixel(random);
        const Eigen::Vector2d plate = back_project(camera, pixel, 3.0);
        const Eigen::Vector3d seen =
            camera_from_plate(camera) *
            (Eigen::Vector3d(plate.x(), plate.y(), camera.distance_mm) - 3.0 * stage_axis(camera));
        EXPECT_LT((ideal_point(camera, pixel) - seen.head<2>() / seen.z()).norm(), 1e-13) << "seed " << seed;
        const Eigen::Vector2d step(0.01, -0.02);
        const Eigen::Vector2d difference =
            0.5 * (ideal_point(camera, pixel + step) - ideal_point(camera, pixel - step));
        EXPECT_LT((ideal_by_image(camera, pixel) * step - difference).norm(), 1e-6 * difference.norm());
    }
}

TEST(CameraGeometry, LensThatFoldsTheImage_IsSeen) {
    CameraGeometry camera = straight_camera();
    camera.focal_px = 800.0;  // the corners lie at a radius of 1
    EXPECT_TRUE(lens_is_one_to_one(camera));
    camera.distortion.k1 = -0.1;
    EXPECT_TRUE(lens_is_one_to_one(camera));
    camera.distortion.k1 = -0.4;  // largest radius that is pictured: (2 / 3) / sqrt(1.2) = 0.61
    EXPECT_FALSE(lens_is_one_to_one(camera));
    camera.distortion = {.p1 = 0.5};
    EXPECT_FALSE(lens_is_one_to_one(camera));
}

}  // namespace
}  // namespace fidservo
