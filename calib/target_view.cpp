#include "calib/target_view.h"

#include "vision/quad.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

namespace fidservo::calib {

std::array<Eigen::Vector2d, 4> printed_corners_mm(const PlateTag& tag) {
    const Eigen::Rotation2Dd turn(tag.angle_rad);
    std::array<Eigen::Vector2d, 4> corners;
    for (std::size_t k = 0; k < 4; ++k)
        corners[k] = tag.centre_mm + turn * Eigen::Vector2d(0.5 * tag.side_mm * vision::tag_corners[k]);
    return corners;
}

CornerWeights corner_weights(const vision::CornerCovariance& covariance_px2, double extra_std_px) {
    constexpr double unmeasured = 1e-9;  // variance against the largest one: rounding of a singular matrix
    const Eigen::SelfAdjointEigenSolver<vision::CornerCovariance> parts(
        0.5 * (covariance_px2 + covariance_px2.transpose()));
    const double largest = parts.eigenvalues().tail<1>()(0);
    CornerWeights weights{Eigen::Matrix<double, 8, 8>::Zero(), 0};
    for (int k = 7; k >= 0; --k) {
        const double variance = parts.eigenvalues()(k);
        if (!(variance > unmeasured * largest)) break;
        weights.whiten.row(weights.rank++) =
            parts.eigenvectors().col(k).transpose() / std::hypot(std::sqrt(variance), extra_std_px);
    }
    return weights;
}

}  // namespace fidservo::calib
