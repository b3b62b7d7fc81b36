// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/tags/quad.h"

#include <algorithm>

#include <Eigen/LU>

namespace fidservo::vision {

Eigen::Matrix3d square_to_image(const std::array<Eigen::Vector2d, 4>& corners_px) {
    Eigen::Matrix<double, 8, 8> system;
    Eigen::Matrix<double, 8, 1> right;
    for (int k = 0; k < 4; ++k) {
        const double x = tag_corners[k].x();
        const double y = tag_corners[k].y();
        const double u = corners_px[k].x();
        const double v = corners_px[k].y();
        system.row(2 * k) << x, y, 1, 0, 0, 0, -x * u, -y * u;
        system.row(2 * k + 1) << 0, 0, 0, x, y, 1, -x * v, -y * v;
        right(2 * k) = u;
        right(2 * k + 1) = v;
    }
    const Eigen::Matrix<double, 8, 1> h = system.partialPivLu().solve(right);
    Eigen::Matrix3d homography;
    homography << h(0), h(1), h(2), h(3), h(4), h(5), h(6), h(7), 1.0;
    return homography;
}

Eigen::Vector2d centre_of(const std::array<Eigen::Vector2d, 4>& corners_px) {
    return map_point(square_to_image(corners_px), {0.0, 0.0});
}

bool is_mirrored(const std::array<Eigen::Vector2d, 4>& corners_px) {
    const Eigen::Vector2d along = corners_px[2] - corners_px[0], across = corners_px[3] - corners_px[1];
    return along.x() * across.y() - along.y() * across.x() > 0.0;
}

std::array<Eigen::Vector2d, 4> mirrored(const std::array<Eigen::Vector2d, 4>& corners_px) {
    return {corners_px[1], corners_px[0], corners_px[3], corners_px[2]};
}

double longest_side_px(const std::array<Eigen::Vector2d, 4>& corners_px) {
    double longest = 0.0;
    for (std::size_t k = 0; k < 4; ++k)
        longest = std::max(longest, (corners_px[(k + 1) % 4] - corners_px[k]).norm());
    return longest;
}

bool same_place(const std::array<Eigen::Vector2d, 4>& a_px, const std::array<Eigen::Vector2d, 4>& b_px) {
    return (centre_of(a_px) - centre_of(b_px)).norm() <
           0.5 * std::min(longest_side_px(a_px), longest_side_px(b_px));
}

}  // namespace fidservo::vision
