// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/camera.h"

#include "core/random.h"
#include "plant/actual_camera.h"

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace fidservo::plant {
namespace {

constexpr double rad_per_deg = std::numbers::pi / 180.0;
const CameraGeometry reference{1280, 960, 5000.0, {639.5, 479.5}, 20.0};

TEST(ActualCamera, WithoutDeviation_IsTheNominalProjectionBitForBit) {
    const ActualCamera actual = actual_camera(reference, {});
    NoiseStream draw(3, "points");
    for (int k = 0; k < 100; ++k) {
        const Eigen::Vector2d point(200.0 * draw.uniform(), 4.0 * draw.uniform() - 2.0);
        const double s_mm = 200.0 * draw.uniform();
        EXPECT_EQ(actual.image_px(point, s_mm), project(reference, point, s_mm));
        EXPECT_EQ(actual.plate_mm(point, s_mm), back_project(reference, point, s_mm));
    }
}

TEST(ActualCamera, Scale_IsAboutThePrincipalPoint) {
    const ActualCamera actual = actual_camera(reference, {.pixel_scale = 1.02});
    EXPECT_NEAR((actual.image_px({51.0, -0.4}, 50.0) - Eigen::Vector2d(639.5 + 255.0, 479.5 - 102.0)).norm(),
                0.0, 1e-9);
}

TEST(ActualCamera, Rotation_TurnsFromUTowardsV) {
    const ActualCamera actual = actual_camera(reference, {.rotation_rad = 30.0 * rad_per_deg});
    const Eigen::Vector2d seen = actual.image_px({51.0, 0.0}, 50.0);
    EXPECT_NEAR(seen.x(), 639.5 + 250.0 * std::cos(30.0 * rad_per_deg), 1e-9);
    EXPECT_NEAR(seen.y(), 479.5 + 125.0, 1e-9);
}

TEST(ActualCamera, Tilt_IsThePinholesPerspective) {
    const double angle = 2.0 * rad_per_deg;
    const ActualCamera actual = actual_camera(reference, {.tilt_rad = {angle, 0.0}, .tilt_axis_height = 1.0});
    // About u: y' = y cos - z sin, z' = y sin + z cos.
    for (const Eigen::Vector2d& point : {Eigen::Vector2d(0.0, 0.0), {1.0, 0.7}, {-2.0, -1.5}}) {
        const double y = point.y() * std::cos(angle) - 20.0 * std::sin(angle);
        const double z = point.y() * std::sin(angle) + 20.0 * std::cos(angle);
        const Eigen::Vector2d seen = actual.image_px(point + Eigen::Vector2d(50.0, 0.0), 50.0);
        EXPECT_NEAR(seen.x(), 639.5 + 5000.0 * point.x() / z, 1e-9);
        EXPECT_NEAR(seen.y(), 479.5 + 5000.0 * y / z, 1e-9);
    }
    EXPECT_NEAR(actual.image_px({50.0, 0.0}, 50.0).y(), 479.5 - 5000.0 * std::tan(angle), 1e-9);
}

TEST(ActualCamera, TiltAboutThePlate_LeavesWhatItLooksAt) {
    const double angle = 2.0 * rad_per_deg;
    const ActualCamera actual = actual_camera(reference, {.tilt_rad = {0.0, angle}});
    EXPECT_NEAR((actual.image_px({50.0, 0.0}, 50.0) - reference.principal_point_px).norm(), 0.0, 1e-9);
    // About v: x' = x cos + (z - 20) sin, z' = 20 - x sin + (z - 20) cos, at z = 20.
    const Eigen::Vector2d seen = actual.image_px({51.0, 0.5}, 50.0);
    const double depth = 20.0 - std::sin(angle);
    EXPECT_NEAR(seen.x(), 639.5 + 5000.0 * std::cos(angle) / depth, 1e-9);
    EXPECT_NEAR(seen.y(), 479.5 + 5000.0 * 0.5 / depth, 1e-9);
}

TEST(ActualCamera, Distortion_IsRadial) {
    const ActualCamera actual = actual_camera(reference, {.distortion = -0.3});
    const double r = 0.1;  // focal lengths: 2 mm at 20 mm
    const Eigen::Vector2d seen = actual.image_px({50.0 + 1.6, 1.2}, 50.0) - reference.principal_point_px;
    EXPECT_NEAR(seen.norm(), 5000.0 * r * (1.0 - 0.3 * r * r), 1e-9);
    EXPECT_NEAR(seen.y() / seen.x(), 0.75, 1e-12);
}

TEST(ActualCamera, BackProjection_IsTheInverse) {
    NoiseStream draw(5, "cameras");
    for (int k = 0; k < 300; ++k) {
        const CameraDeviation deviation{
            .pixel_scale = 0.9 + 0.2 * draw.uniform(),
            .rotation_rad = 0.3 * (draw.uniform() - 0.5),
            .tilt_rad = {0.1 * (draw.uniform() - 0.5), 0.1 * (draw.uniform() - 0.5)},
            .tilt_axis_height = 2.0 * draw.uniform() - 0.5,
            .distortion = 4.0 * (draw.uniform() - 0.5)};
        const ActualCamera actual = actual_camera(reference, deviation);
        const Eigen::Vector2d pixel(1280.0 * draw.uniform(), 960.0 * draw.uniform());
        const double s_mm = 200.0 * draw.uniform();
        EXPECT_NEAR((actual.image_px(actual.plate_mm(pixel, s_mm), s_mm) - pixel).norm(), 0.0, 1e-8)
            << "seed 5, case " << k;
    }
}

TEST(ActualCamera, DeviationOfAGeneralCamera_FollowsTheNominalRotation) {
    NoiseStream draw(8, "general_cameras");
    for (int k = 0; k < 300; ++k) {
        CameraGeometry nominal = reference;
        nominal.focal_ratio = 0.99 + 0.02 * draw.uniform();
        nominal.distortion = {.k1 = -0.2, .k2 = 0.1 * draw.uniform(), .p1 = 0.002, .p2 = -0.001, .k3 = 0.3};
        nominal.rotation_rad = 6.0 * (draw.uniform() - 0.5);
        nominal.tilt_rad = {0.2 * (draw.uniform() - 0.5), 0.2 * (draw.uniform() - 0.5)};
        nominal.axis_rad = {0.001 * draw.uniform(), -0.001 * draw.uniform()};
        const CameraDeviation deviation{
            .pixel_scale = 0.9 + 0.2 * draw.uniform(),
            .rotation_rad = 0.3 * (draw.uniform() - 0.5),
            .tilt_rad = {0.1 * (draw.uniform() - 0.5), 0.1 * (draw.uniform() - 0.5)},
            .tilt_axis_height = 2.0 * draw.uniform() - 0.5,
            .distortion = 0.2 * (draw.uniform() - 0.5)};
        const ActualCamera actual = actual_camera(nominal, deviation);
        const Eigen::Vector2d point(100.0 + 2.0 * draw.uniform(), draw.uniform());
        constexpr double s_mm = 100.5;

        // Step by step, as plant/camera.h says it.
        const Eigen::Vector3d axis =
            Eigen::Vector3d(1.0, nominal.axis_rad.x(), nominal.axis_rad.y()).normalized();
        const double angle = deviation.tilt_rad.norm();
        const Eigen::Vector3d about(deviation.tilt_rad.x() / angle, deviation.tilt_rad.y() / angle, 0.0);
        const Eigen::AngleAxisd tilt(angle, about);
        const Eigen::AngleAxisd turn(deviation.rotation_rad, Eigen::Vector3d::UnitZ());
        const Eigen::Vector3d axis_mm(0.0, 0.0, 20.0 * (1.0 - deviation.tilt_axis_height));
        const Eigen::Vector3d nominally =
            camera_from_plate(nominal) * (Eigen::Vector3d(point.x(), point.y(), 20.0) - s_mm * axis);
        const Eigen::Vector3d seen = axis_mm + tilt * (turn * nominally - axis_mm);
        LensDistortion lens = nominal.distortion;
        lens.k1 += deviation.distortion;
        const Eigen::Vector2d pictured = distort(lens, seen.head<2>() / seen.z());
        const double focal_px = 5000.0 * deviation.pixel_scale;
        const Eigen::Vector2d expected =
            nominal.principal_point_px +
            focal_px * Eigen::Vector2d(pictured.x(), nominal.focal_ratio * pictured.y());
        EXPECT_LT((actual.image_px(point, s_mm) - expected).norm(), 1e-8) << "seed 8, case " << k;
    }
}

TEST(CameraRows, MiddleRow_IsExposedAtTheFramesTime) {
    const CameraDeviation rolling{.readout_s = 0.01};
    EXPECT_NEAR(row_delay_s(reference, rolling, 0.0), -0.005, 1e-15);
    EXPECT_NEAR(row_delay_s(reference, rolling, 479.5), 0.0, 1e-15);
    EXPECT_NEAR(row_delay_s(reference, rolling, 959.0), 0.005, 1e-15);
    EXPECT_EQ(row_delay_s(reference, {}, 0.0), 0.0);
}

}  // namespace
}  // namespace fidservo::plant
