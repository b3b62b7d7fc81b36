// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/camera/camera_covariance.h"

#include <gtest/gtest.h>

namespace fidservo {
namespace {

/// 0.004 mm a pixel.
CameraGeometry straight_camera() {
    return {1280, 960, 5000.0, {639.5, 479.5}, 20.0};
}

CameraCovariance only(CameraNumber number, double std) {
    CameraCovariance covariance = CameraCovariance::Zero();
    covariance(number, number) = std * std;
    return covariance;
}

const Eigen::Vector2d left_px(139.5, 479.5), right_px(1139.5, 479.5);  // 4 mm apart along x

TEST(CameraCovariance, DistanceUnknown_LengthensByItsShare) {
    const Eigen::Matrix2d covariance =
        vector_covariance_mm2(straight_camera(), only(camera_distance, 20.0 * 1e-4), left_px, right_px, 50.0);
    EXPECT_NEAR(std::sqrt(covariance(0, 0)), 4.0 * 1e-4, 1e-10);
    EXPECT_NEAR(covariance(1, 1), 0.0, 1e-18);
}

TEST(CameraCovariance, RotationUnknown_TurnsTheVector) {
    const Eigen::Matrix2d covariance =
        vector_covariance_mm2(straight_camera(), only(camera_rotation, 1e-4), left_px, right_px, 50.0);
    EXPECT_NEAR(covariance(0, 0), 0.0, 1e-18);
    EXPECT_NEAR(std::sqrt(covariance(1, 1)), 4.0 * 1e-4, 1e-10);
}

TEST(CameraCovariance, TiltUnknown_CancelsBetweenPointsAlikeAboutTheAxis) {
    // Tilt about v scales the picture by -2 tilt x / Z: both ends move the same way.
    const CameraCovariance tilt = only(camera_tilt_v, 1e-3);
    const CameraGeometry camera = straight_camera();
    const Eigen::Vector2d axis_px = camera.principal_point_px;
    EXPECT_NEAR(vector_covariance_mm2(camera, tilt, left_px, right_px, 0.0)(0, 0), 0.0, 1e-15);
    const double half_way = std::sqrt(vector_covariance_mm2(camera, tilt, axis_px, right_px, 0.0)(0, 0));
    EXPECT_NEAR(half_way, 1e-3 * 2.0 * 2.0 / 20.0, 1e-7);  // x^2 / Z
}

TEST(CameraCovariance, AxisUnknown_LeavesOneImageAsItIs) {
    const CameraCovariance across = only(camera_axis_y, 1e-3);
    EXPECT_NEAR(vector_covariance_mm2(straight_camera(), across, left_px, right_px, 80.0).norm(), 0.0, 1e-15);
}

TEST(CameraCovariance, NumbersPutBack_GiveTheCamera) {
    CameraGeometry camera = straight_camera();
    camera.rotation_rad = 0.1;
    camera.tilt_rad = {0.02, -0.01};
    camera.axis_rad = {0.003, 0.004};
    camera.distortion.k1 = -0.3;
    const CameraGeometry again = with_numbers(straight_camera(), numbers_of(camera));
    EXPECT_EQ(project(again, {1.0, 0.5}, 0.3), project(camera, {1.0, 0.5}, 0.3));
}

TEST(CameraCovariance, CorrelationAboveOne_IsNone) {
    CameraCovariance covariance = CameraCovariance::Identity();
    EXPECT_TRUE(is_covariance(covariance));
    EXPECT_TRUE(is_covariance(CameraCovariance::Zero()));
    covariance(0, 1) = covariance(1, 0) = 1.1;
    EXPECT_FALSE(is_covariance(covariance));
    covariance = CameraCovariance::Identity();
    covariance(3, 3) = -1e-9;
    EXPECT_FALSE(is_covariance(covariance));
}

}  // namespace
}  // namespace fidservo
