// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/camera/pictured_corners.h"

#include "tests/calib/stage_views.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace fidservo::calib {
namespace {

/// The perspective picture nearest to what the lens shows, by Gauss-Newton over all eight numbers: an
/// independent computation that is not limited to first order in the distortion. Points may be arbitrarily
/// dense, and are weighted like the edges.
std::array<Eigen::Vector2d, 4> nearest_perspective(const CameraGeometry& camera, const PlateTag& tag,
                                                   double s_mm) {
    std::vector<Eigen::Vector2d> from, to;
    std::vector<double> weight;
    for (int i = 0; i <= 8; ++i)
        for (int j = 0; j <= 8; ++j) {
            from.emplace_back(i / 4.0 - 1.0, j / 4.0 - 1.0);
            to.push_back(project(camera, tag.centre_mm + 0.5 * tag.side_mm * from.back(), s_mm));
            weight.push_back(i % 8 == 0 || j % 8 == 0 ? 1.0 : 0.5);
        }
    const Eigen::Vector2d origin = to[40];
    Eigen::Matrix<double, 8, 1> h;
    h << 150.0, 0.0, 0.0, 0.0, 150.0, 0.0, 0.0, 0.0;
    const auto picture = [&](const Eigen::Vector2d& p) {
        const double w = 1.0 + h(6) * p.x() + h(7) * p.y();
        return Eigen::Vector2d((h(0) * p.x() + h(1) * p.y() + h(2)) / w,
                               (h(3) * p.x() + h(4) * p.y() + h(5)) / w);
    };
    for (int step = 0; step < 20; ++step) {
        Eigen::Matrix<double, 8, 8> normal = Eigen::Matrix<double, 8, 8>::Zero();
        Eigen::Matrix<double, 8, 1> right = Eigen::Matrix<double, 8, 1>::Zero();
        for (std::size_t k = 0; k < from.size(); ++k) {
            const double x = from[k].x(), y = from[k].y(), w = 1.0 + h(6) * x + h(7) * y;
            const Eigen::Vector2d q = picture(from[k]);
            Eigen::Matrix<double, 2, 8> rate;
            rate << x, y, 1, 0, 0, 0, -q.x() * x, -q.x() * y, 0, 0, 0, x, y, 1, -q.y() * x, -q.y() * y;
            rate /= w;
            normal += weight[k] * rate.transpose() * rate;
            right += weight[k] * rate.transpose() * (to[k] - origin - q);
        }
        h += normal.ldlt().solve(right);
    }
    return {origin + picture({-1, 1}), origin + picture({1, 1}), origin + picture({1, -1}),
            origin + picture({-1, -1})};
}

TEST(PicturedCorners, WithoutDistortion_IsTheProjection) {
    CameraGeometry camera = straight_camera();
    camera.tilt_rad = {0.02, -0.01};
    camera.rotation_rad = 0.3;
    const PlateTag tag{4, {8.0, 0.0}, 1.2, 0.1};
    const auto pictured = pictured_corners(camera, tag, 8.7);
    const auto corners = vision::corners_mm(tag);
    for (std::size_t k = 0; k < 4; ++k)
        EXPECT_LT((pictured[k] - project(camera, corners[k], 8.7)).norm(), 1e-12);
}

TEST(PicturedCorners, OfADistortingLens_IsTheNearestPerspective) {
    CameraGeometry camera = straight_camera();
    camera.distortion.k1 = -0.3;
    camera.rotation_rad = 0.05;
    camera.tilt_rad = {0.01, 0.01};
    const PlateTag tag{4, {8.0, 0.0}, 1.2};
    for (const double s_mm : {6.3, 7.5, 8.0, 9.2}) {
        const auto pictured = pictured_corners(camera, tag, s_mm);
        const auto nearest = nearest_perspective(camera, tag, s_mm);
        const auto corners = vision::corners_mm(tag);
        for (std::size_t k = 0; k < 4; ++k) {
            const double bend_px = (nearest[k] - project(camera, corners[k], s_mm)).norm();
            EXPECT_LT((pictured[k] - nearest[k]).norm(), 0.02 * bend_px + 1e-4) << s_mm << " corner " << k;
        }
    }
}

}  // namespace
}  // namespace fidservo::calib
