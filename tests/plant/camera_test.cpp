#include "plant/camera.h"

#include "core/random.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace fidservo::plant {
namespace {

constexpr double rad_per_deg = std::numbers::pi / 180.0;
const CameraGeometry reference{1280, 960, 5000.0, {639.5, 479.5}, 20.0};

TEST(CameraOptics, WithoutDeviation_IsTheNominalProjectionBitForBit) {
    const CameraOptics optics = make_camera_optics(reference, {});
    NoiseStream draw(3, "points");
    for (int k = 0; k < 100; ++k) {
        const Eigen::Vector2d point(200.0 * draw.uniform(), 4.0 * draw.uniform() - 2.0);
        const double s_mm = 200.0 * draw.uniform();
        EXPECT_EQ(project(optics, point, s_mm), fidservo::project(reference, point, s_mm));
        EXPECT_EQ(back_project(optics, point, s_mm), fidservo::back_project(reference, point, s_mm));
    }
}

TEST(CameraOptics, Scale_IsAboutThePrincipalPoint) {
    const CameraOptics optics = make_camera_optics(reference, {.pixel_scale = 1.02});
    EXPECT_NEAR((project(optics, {51.0, -0.4}, 50.0) - Eigen::Vector2d(639.5 + 255.0, 479.5 - 102.0)).norm(),
                0.0, 1e-9);
}

TEST(CameraOptics, Rotation_TurnsFromUTowardsV) {
    const CameraOptics optics = make_camera_optics(reference, {.rotation_rad = 30.0 * rad_per_deg});
    const Eigen::Vector2d seen = project(optics, {51.0, 0.0}, 50.0);
    EXPECT_NEAR(seen.x(), 639.5 + 250.0 * std::cos(30.0 * rad_per_deg), 1e-9);
    EXPECT_NEAR(seen.y(), 479.5 + 125.0, 1e-9);
}

TEST(CameraOptics, Tilt_IsThePinholesPerspective) {
    const double angle = 2.0 * rad_per_deg;
    const CameraOptics optics = make_camera_optics(reference, {.tilt_rad = {angle, 0.0}});
    // About u: y' = y cos - z sin, z' = y sin + z cos.
    for (const Eigen::Vector2d& point : {Eigen::Vector2d(0.0, 0.0), {1.0, 0.7}, {-2.0, -1.5}}) {
        const double y = point.y() * std::cos(angle) - 20.0 * std::sin(angle);
        const double z = point.y() * std::sin(angle) + 20.0 * std::cos(angle);
        const Eigen::Vector2d seen = project(optics, point + Eigen::Vector2d(50.0, 0.0), 50.0);
        EXPECT_NEAR(seen.x(), 639.5 + 5000.0 * point.x() / z, 1e-9);
        EXPECT_NEAR(seen.y(), 479.5 + 5000.0 * y / z, 1e-9);
    }
    EXPECT_NEAR(project(optics, {50.0, 0.0}, 50.0).y(), 479.5 - 5000.0 * std::tan(angle), 1e-9);
}

TEST(CameraOptics, Distortion_IsRadial) {
    const CameraOptics optics = make_camera_optics(reference, {.distortion = -0.3});
    const double r = 0.1;  // focal lengths: 2 mm at 20 mm
    const Eigen::Vector2d seen = project(optics, {50.0 + 1.6, 1.2}, 50.0) - reference.principal_point_px;
    EXPECT_NEAR(seen.norm(), 5000.0 * r * (1.0 - 0.3 * r * r), 1e-9);
    EXPECT_NEAR(seen.y() / seen.x(), 0.75, 1e-12);
}

TEST(CameraOptics, BackProjection_IsTheInverse) {
    NoiseStream draw(5, "cameras");
    for (int k = 0; k < 300; ++k) {
        const CameraDeviation deviation{
            .pixel_scale = 0.9 + 0.2 * draw.uniform(),
            .rotation_rad = 0.3 * (draw.uniform() - 0.5),
            .tilt_rad = {0.1 * (draw.uniform() - 0.5), 0.1 * (draw.uniform() - 0.5)},
            .distortion = 4.0 * (draw.uniform() - 0.5)};
        const CameraOptics optics = make_camera_optics(reference, deviation);
        const Eigen::Vector2d pixel(1280.0 * draw.uniform(), 960.0 * draw.uniform());
        const double s_mm = 200.0 * draw.uniform();
        EXPECT_NEAR((project(optics, back_project(optics, pixel, s_mm), s_mm) - pixel).norm(), 0.0, 1e-8)
            << "seed 5, case " << k;
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
