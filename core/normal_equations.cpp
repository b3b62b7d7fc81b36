// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/normal_equations.h"

#include <limits>

namespace fidservo {

template <int N>
NormalFactor<N>::NormalFactor(const Matrix& normal) : factor_(normal) {}

template <int N>
bool NormalFactor<N>::has_succeeded() const {
    return factor_.info() == Eigen::Success;
}

template <int N>
bool NormalFactor<N>::is_positive() const {
    return factor_.isPositive();
}

template <int N>
double NormalFactor<N>::reciprocal_condition() const {
    // Eigen passes over a pivot of zero when it solves, and so takes what is exactly singular for regular.
    const Vector pivots = factor_.vectorD().cwiseAbs();
    if (!(pivots.minCoeff() > std::numeric_limits<double>::epsilon() * pivots.maxCoeff())) return 0.0;
    return factor_.rcond();
}

template <int N>
typename NormalFactor<N>::Vector NormalFactor<N>::solve(const Vector& right) const {
    return factor_.solve(right);
}

template <int N>
typename NormalFactor<N>::Matrix NormalFactor<N>::inverse() const {
    return factor_.solve(Matrix::Identity());
}

template class NormalFactor<2>;
template class NormalFactor<3>;
template class NormalFactor<4>;
template class NormalFactor<5>;
template class NormalFactor<6>;

}  // namespace fidservo
