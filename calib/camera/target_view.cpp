// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/camera/target_view.h"

#include "calib/dense.h"

#include <cmath>

namespace fidservo::calib {

CornerWeights corner_weights(const vision::CornerCovariance& covariance_px2, double extra_std_px) {
    constexpr double unmeasured = 1e-9;  // variance against the largest one: rounding of a singular matrix
    const SymmetricParts parts = symmetric_parts(0.5 * (covariance_px2 + covariance_px2.transpose()));
    const double largest = parts.values(7);
    CornerWeights weights{Eigen::Matrix<double, 8, 8>::Zero(), 0};
    for (int k = 7; k >= 0; --k) {
        const double variance = parts.values(k);
        if (!(variance > unmeasured * largest)) break;
        weights.whiten.row(weights.rank++) =
            parts.vectors.col(k).transpose() / std::hypot(std::sqrt(variance), extra_std_px);
    }
    return weights;
}

}  // namespace fidservo::calib
