#include "vision/quad.h"

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

}  // namespace fidservo::vision
