// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/affine_step.h"

#include <Eigen/Dense>
#include <unsupported/Eigen/MatrixFunctions>

namespace fidservo::plant {

template <std::size_t size>
SquareMatrix<size> affine_step(const SquareMatrix<size>& rates, double duration_s) {
    constexpr int n = static_cast<int>(size);
    using Square = Eigen::Matrix<double, n, n, Eigen::RowMajor>;
    using Wide = Eigen::Matrix<double, 2 * n, 2 * n>;
    // exp of [A 1; 0 0] h has G in its upper right corner (Van Loan, IEEE Trans. Autom. Control 23, 1978).
    Wide generator = Wide::Zero();
    generator.template topLeftCorner<n, n>() = Eigen::Map<const Square>(rates.front().data()) * duration_s;
    generator.template topRightCorner<n, n>() = Square::Identity() * duration_s;
    const Wide propagator = generator.exp();
    SquareMatrix<size> step;
    Eigen::Map<Square>(step.front().data()) = propagator.template topRightCorner<n, n>();
    return step;
}

template SquareMatrix<2> affine_step<2>(const SquareMatrix<2>&, double);
template SquareMatrix<4> affine_step<4>(const SquareMatrix<4>&, double);

}  // namespace fidservo::plant
