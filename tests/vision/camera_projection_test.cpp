// SPDX-License-Identifier: GPL-3.0-or-later
// The camera's projection against OpenCV's, an independent second method.
#include "core/camera/camera_geometry.h"
#include "core/random.h"

#include <cstdint>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>

namespace fidservo {
namespace {

constexpr std::uint64_t seed = 5;

double between(NoiseStream& random, double low, double high) {
    return low + (high - low) * random.uniform();
}

/// OpenCV's picture of plate points: rotation vectors composed and the plate moved against the stage's axis.
std::vector<cv::Point2d> projected_by_opencv(const CameraGeometry& camera,
                                             const std::vector<Eigen::Vector2d>& plate_mm, double s_mm) {
    cv::Mat turn, tilt;
    cv::Rodrigues(cv::Vec3d(0, 0, camera.rotation_rad), turn);
    cv::Rodrigues(cv::Vec3d(camera.tilt_rad.x(), camera.tilt_rad.y(), 0), tilt);
    const cv::Mat both = tilt * turn;
    cv::Mat rotation;
    cv::Rodrigues(both, rotation);
    cv::Vec3d axis(1.0, camera.axis_rad.x(), camera.axis_rad.y());
    axis /= cv::norm(axis);
    const cv::Mat moved =
        (cv::Mat_<double>(3, 1) << -s_mm * axis[0], -s_mm * axis[1], camera.distance_mm - s_mm * axis[2]);
    const cv::Mat translation = both * moved;
    const cv::Matx33d matrix(camera.focal_px, 0, camera.principal_point_px.x(), 0,
                             camera.focal_px * camera.focal_ratio, camera.principal_point_px.y(), 0, 0, 1);
    const LensDistortion& lens = camera.distortion;
    const std::vector<double> coefficients{lens.k1, lens.k2, lens.p1, lens.p2, lens.k3};
    std::vector<cv::Point3d> points;
    points.reserve(plate_mm.size());
    for (const Eigen::Vector2d& point : plate_mm) points.emplace_back(point.x(), point.y(), 0.0);
    std::vector<cv::Point2d> image;
    cv::projectPoints(points, rotation, translation, matrix, coefficients, image);
    return image;
}

TEST(CameraProjection, AnyCamera_AgreesWithOpenCv) {
    NoiseStream random(seed, "camera_projection_test");
    for (int k = 0; k < 300; ++k) {
        const CameraGeometry camera{
            .width_px = 1280,
            .height_px = 960,
            .focal_px = between(random, 1500, 6000),
            .principal_point_px = {between(random, 600, 680), between(random, 440, 520)},
            .distance_mm = between(random, 10, 40),
            .focal_ratio = between(random, 0.97, 1.03),
            .distortion = {.k1 = between(random, -0.3, 0.3),
                           .k2 = between(random, -0.2, 0.2),
                           .p1 = between(random, -0.01, 0.01),
                           .p2 = between(random, -0.01, 0.01),
                           .k3 = between(random, -0.1, 0.1)},
            .rotation_rad = between(random, -3.0, 3.0),
            .tilt_rad = {between(random, -0.2, 0.2), between(random, -0.2, 0.2)},
            .axis_rad = {between(random, -0.002, 0.002), between(random, -0.002, 0.002)}};
        const double s_mm = between(random, 0.0, 200.0);
        std::vector<Eigen::Vector2d> plate_mm;
        for (int i = 0; i < 10; ++i)
            plate_mm.emplace_back(s_mm + between(random, -3, 3), between(random, -2, 2));
        const std::vector<cv::Point2d> theirs = projected_by_opencv(camera, plate_mm, s_mm);
        for (std::size_t i = 0; i < plate_mm.size(); ++i) {
            const Eigen::Vector2d ours = project(camera, plate_mm[i], s_mm);
            EXPECT_NEAR(ours.x(), theirs[i].x, 1e-8) << "seed " << seed << ", case " << k;
            EXPECT_NEAR(ours.y(), theirs[i].y, 1e-8) << "seed " << seed << ", case " << k;
        }
    }
}

}  // namespace
}  // namespace fidservo
