// SPDX-License-Identifier: GPL-3.0-or-later
// Both lens models: against OpenCV, back and forth, their derivatives, the end of their domain.
#include "core/camera/lens.h"

#include "core/camera/camera_geometry.h"
#include "core/camera/camera_slopes.h"
#include "core/random.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

namespace fidservo {
namespace {

constexpr std::uint64_t seed = 17;
constexpr double deg = std::numbers::pi / 180.0;

double between(NoiseStream& random, double low, double high) {
    return low + (high - low) * random.uniform();
}

/// As published calibrations of fisheyes have them.
LensDistortion some_fisheye(NoiseStream& random) {
    return {.k1 = between(random, -0.05, 0.05),
            .k2 = between(random, -0.01, 0.01),
            .k3 = between(random, -0.003, 0.003),
            .k4 = between(random, -0.0005, 0.0005),
            .model = LensModel::equidistant};
}

Eigen::Vector3d direction_at(double theta_rad, double around_rad) {
    return {std::sin(theta_rad) * std::cos(around_rad), std::sin(theta_rad) * std::sin(around_rad),
            std::cos(theta_rad)};
}

cv::Vec4d opencv_numbers(const LensDistortion& lens) {
    return {lens.k1, lens.k2, lens.k3, lens.k4};
}

TEST(Lens, Equidistant_PicturesAsOpenCVDoes) {
    NoiseStream random(seed, "lens_test opencv");
    for (int k = 0; k < 200; ++k) {
        const LensDistortion lens = some_fisheye(random);
        const Eigen::Vector3d ray = direction_at(between(random, 0.0, 1.5), between(random, -3.1, 3.1));
        const std::vector<cv::Point3d> points{{ray.x(), ray.y(), ray.z()}};
        std::vector<cv::Point2d> pictured;
        cv::fisheye::projectPoints(points, pictured, cv::Affine3d::Identity(), cv::Matx33d::eye(),
                                   opencv_numbers(lens));
        const Eigen::Vector2d ours = picture_of(lens, ray);
        EXPECT_NEAR(ours.x(), pictured[0].x, 1e-12) << "seed " << seed << ", case " << k;
        EXPECT_NEAR(ours.y(), pictured[0].y, 1e-12) << "seed " << seed << ", case " << k;
    }
}

TEST(Lens, Equidistant_UndistortsAsOpenCVDoes) {
    NoiseStream random(seed, "lens_test opencv back");
    for (int k = 0; k < 200; ++k) {
        const LensDistortion lens = some_fisheye(random);
        const Eigen::Vector3d ray = direction_at(between(random, 0.0, 1.3), between(random, -3.1, 3.1));
        const Eigen::Vector2d pictured = picture_of(lens, ray);
        const std::vector<cv::Point2d> seen{{pictured.x(), pictured.y()}};
        std::vector<cv::Point2d> ideal;
        cv::fisheye::undistortPoints(seen, ideal, cv::Matx33d::eye(), opencv_numbers(lens), cv::noArray(),
                                     cv::noArray(), cv::TermCriteria(cv::TermCriteria::COUNT, 30, 0.0));
        const Eigen::Vector2d ours = undistort(lens, pictured);
        EXPECT_NEAR(ours.x(), ideal[0].x, 1e-7 * (1.0 + ours.norm())) << "seed " << seed << ", case " << k;
        EXPECT_NEAR(ours.y(), ideal[0].y, 1e-7 * (1.0 + ours.norm())) << "seed " << seed << ", case " << k;
    }
}

TEST(Lens, Equidistant_RayOfIsTheInverseOfPictureOfBehindTheCameraToo) {
    NoiseStream random(seed, "lens_test inverse");
    int seen_behind = 0;
    for (int k = 0; k < 2000; ++k) {
        const LensDistortion lens = some_fisheye(random);
        const double theta_rad = between(random, 0.0, 100.0 * deg);
        const Eigen::Vector3d ray = direction_at(theta_rad, between(random, -3.1, 3.1));
        const Eigen::Vector2d pictured = picture_of(lens, 7.0 * ray);
        if (!pictured.allFinite()) {
            EXPECT_GT(theta_rad, domain_rad(lens)) << "seed " << seed << ", case " << k;
            continue;
        }
        seen_behind += ray.z() < 0.0 ? 1 : 0;
        // Where theta_d hardly rises, its rounding is a larger part of theta.
        if (theta_rad > 0.98 * domain_rad(lens)) continue;
        EXPECT_LT((ray_of(lens, pictured) - ray).norm(), 1e-12) << "seed " << seed << ", case " << k;
    }
    EXPECT_GT(seen_behind, 50);
}

TEST(Lens, Equidistant_PictureBeyondItsDomainIsNone) {
    // d theta_d / d theta = 1 - 0.6 theta^2 is 0 at theta = 1.29, where theta_d = 0.861.
    const LensDistortion lens{.k1 = -0.2, .model = LensModel::equidistant};
    const double last_rad = std::sqrt(1.0 / 0.6);
    EXPECT_NEAR(domain_rad(lens), last_rad, 1e-12);
    const double radius = last_rad * (1.0 - 0.2 * last_rad * last_rad);
    EXPECT_TRUE(ray_of(lens, {0.0, radius - 1e-9}).allFinite());
    EXPECT_FALSE(ray_of(lens, {0.0, radius + 1e-9}).allFinite());
    EXPECT_TRUE(picture_of(lens, direction_at(last_rad - 1e-6, 0.3)).allFinite());
    EXPECT_FALSE(picture_of(lens, direction_at(last_rad + 1e-6, 0.3)).allFinite());
}

TEST(Lens, EquidistantThatFallsAndRisesAgain_EndsWhereItFirstFalls) {
    // 1 - 1.2 t + 0.3 t^2 with t = theta^2 falls below 0 between its two roots.
    const LensDistortion lens{.k1 = -0.4, .k2 = 0.06, .model = LensModel::equidistant};
    EXPECT_NEAR(domain_rad(lens), std::sqrt((1.2 - std::sqrt(1.44 - 1.2)) / 0.6), 1e-12);
}

TEST(Lens, EquidistantWithoutCoefficients_PicturesAllDirections) {
    const LensDistortion lens{.model = LensModel::equidistant};
    EXPECT_FALSE(lens.is_none());
    EXPECT_EQ(domain_rad(lens), std::numbers::pi);
    EXPECT_NEAR(picture_of(lens, direction_at(3.0, 0.0)).x(), 3.0, 1e-12);
    EXPECT_FALSE(undistort(lens, {2.0, 0.0}).allFinite()) << "a ray from behind has no x / z";
    EXPECT_EQ(picture_of(lens, Eigen::Vector3d(0.0, 0.0, 5.0)), Eigen::Vector2d(0.0, 0.0));
}

TEST(Lens, AnyModel_DerivativesAreFiniteDifferences) {
    NoiseStream random(seed, "lens_test derivatives");
    for (int k = 0; k < 400; ++k) {
        const bool fisheye = k % 2 == 0;
        const LensDistortion lens = fisheye ? some_fisheye(random)
                                            : LensDistortion{.k1 = between(random, -0.2, 0.2),
                                                             .k2 = between(random, -0.05, 0.05),
                                                             .p1 = between(random, -0.01, 0.01),
                                                             .p2 = between(random, -0.01, 0.01),
                                                             .k3 = between(random, -0.01, 0.01)};
        const Eigen::Vector2d ideal(between(random, -0.7, 0.7), between(random, -0.7, 0.7));
        const Eigen::Vector3d ahead =
            fisheye ? direction_at(between(random, 0.0, 1.7), between(random, -3.1, 3.1))
                    : Eigen::Vector3d(ideal.x(), ideal.y(), 1.0);
        // Near the end of the domain theta of theta_d has no derivative.
        if (fisheye && std::atan2(ahead.head<2>().norm(), ahead.z()) > 0.9 * domain_rad(lens)) continue;
        const Eigen::Vector2d pictured = picture_of(lens, ahead);
        constexpr double step = 1e-6;
        for (int axis = 0; axis < 2; ++axis) {
            const Eigen::Vector2d by = step * Eigen::Vector2d::Unit(axis);
            const Eigen::Vector2d forwards =
                (distort(lens, ideal + by) - distort(lens, ideal - by)) / (2 * step);
            EXPECT_LT((distortion_slope(lens, ideal).col(axis) - forwards).norm(), 1e-8)
                << "seed " << seed << ", case " << k;
            const Eigen::Vector3d back =
                (ray_of(lens, pictured + by) - ray_of(lens, pictured - by)) / (2 * step);
            EXPECT_LT((ray_slope(lens, ahead).col(axis) - back).norm(), 1e-7)
                << "seed " << seed << ", case " << k;
        }
    }
}

TEST(Lens, NumbersOfEitherModel_AreTheSameLensAgain) {
    const std::vector<double> four{0.1, 0.2, 0.3, 0.4}, five{0.1, 0.2, 0.3, 0.4, 0.5};
    EXPECT_EQ(numbers_of(distortion_of(LensModel::equidistant, four)), four);
    EXPECT_EQ(numbers_of(distortion_of(LensModel::plumb_bob, five)), five);
    EXPECT_EQ(distortion_of(LensModel::plumb_bob, five).p2, 0.4);
    EXPECT_EQ(distortion_of(LensModel::equidistant, four).k4, 0.4);
}

/// Tilted and turned, 195 degrees across its picture's circle.
CameraGeometry fisheye_camera() {
    CameraGeometry camera{512, 512, 191.0, {254.9, 256.9}, 30.0};
    camera.focal_ratio = 1.002;
    camera.distortion = {
        .k1 = 0.0035, .k2 = 0.0007, .k3 = -0.002, .k4 = 0.0002, .model = LensModel::equidistant};
    camera.rotation_rad = 0.02;
    camera.tilt_rad = {0.1, -0.15};
    return camera;
}

TEST(Lens, FisheyeCamera_PixelToPlateAndBackIsTheSamePixel) {
    const CameraGeometry camera = fisheye_camera();
    ASSERT_TRUE(lens_is_one_to_one(camera));
    NoiseStream random(seed, "lens_test camera");
    int of_the_plate = 0;
    for (int k = 0; k < 2000; ++k) {
        const Eigen::Vector2d pixel(between(random, -0.5, 511.5), between(random, -0.5, 511.5));
        const Eigen::Vector2d plate_mm = back_project(camera, pixel, 3.0);
        if (!plate_mm.allFinite()) {
            EXPECT_GT((pixel - camera.principal_point_px).norm(), 191.0 * 70.0 * deg);
            continue;
        }
        ++of_the_plate;
        EXPECT_LT((project(camera, plate_mm, 3.0) - pixel).norm(), 1e-8) << "seed " << seed << ", case " << k;
        if (plate_mm.norm() > 500.0) continue;
        constexpr double step_px = 1e-4;
        for (int axis = 0; axis < 2; ++axis) {
            const Eigen::Vector2d by = step_px * Eigen::Vector2d::Unit(axis);
            const Eigen::Vector2d slope =
                (back_project(camera, pixel + by, 3.0) - back_project(camera, pixel - by, 3.0)) /
                (2 * step_px);
            const Eigen::Vector2d said = plate_by_image(camera, pixel, 3.0).col(axis);
            EXPECT_LT((said - slope).norm(), 1e-5 * slope.norm()) << "seed " << seed << ", case " << k;
        }
    }
    EXPECT_GT(of_the_plate, 1000);
}

TEST(Lens, FisheyeWhosePictureEndsInsideTheImage_IsNotOneToOne) {
    CameraGeometry camera = fisheye_camera();
    camera.distortion = {.k1 = -0.2, .model = LensModel::equidistant};  // ends at 0.861 focal lengths
    EXPECT_FALSE(lens_is_one_to_one(camera));
    camera.focal_px = 300.0;  // at 258 px, beyond the nearest side at 254.6 px
    EXPECT_TRUE(lens_is_one_to_one(camera));
}

}  // namespace
}  // namespace fidservo
