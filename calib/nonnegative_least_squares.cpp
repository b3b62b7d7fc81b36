// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/nonnegative_least_squares.h"

#include "core/demand.h"
#include "core/failure.h"

#include <algorithm>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace fidservo::calib {

namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Indices = std::vector<Eigen::Index>;

constexpr int full_exchanges = 10;   ///< tries without progress before falling back on single exchanges
constexpr int most_rounds = 20'000;  ///< single exchanges are finite, but a bound is better than a proof

/// The unconstrained minimum over the free coefficients, the others zero.
bool solve_free(const Eigen::Map<const RowMajor>& g, const Eigen::Map<const Eigen::VectorXd>& b,
                const std::vector<bool>& is_free, Eigen::VectorXd& w) {
    Indices free;
    free.reserve(is_free.size());
    for (std::size_t i = 0; i < is_free.size(); ++i)
        if (is_free[i]) free.push_back(static_cast<Eigen::Index>(i));
    w.setZero();
    if (free.empty()) return true;
    const Eigen::LLT<Eigen::MatrixXd> factor(g(free, free));
    if (factor.info() != Eigen::Success) return false;
    const Eigen::VectorXd part = factor.solve(Eigen::VectorXd(b(free)));
    w(free) = part;
    return w.allFinite();
}

}  // namespace

Result<std::vector<double>> nonnegative_least_squares(std::span<const double> matrix,
                                                      std::span<const double> rhs) {
    const auto n = static_cast<Eigen::Index>(rhs.size());
    FIDSERVO_DEMAND(matrix.size() == rhs.size() * rhs.size());
    const Eigen::Map<const RowMajor> g(matrix.data(), n, n);
    const Eigen::Map<const Eigen::VectorXd> b(rhs.data(), n);
    const double tolerance = 1e-12 * (1.0 + (n > 0 ? b.cwiseAbs().maxCoeff() : 0.0));

    std::vector<bool> is_free(rhs.size(), true);
    Eigen::VectorXd w(n), gradient(n);
    Indices wrong;
    wrong.reserve(rhs.size());
    std::size_t fewest = rhs.size() + 1;
    int tries = full_exchanges;
    for (int round = 0; round < most_rounds; ++round) {
        if (!solve_free(g, b, is_free, w)) break;
        gradient = g * w - b;
        wrong.clear();
        for (Eigen::Index i = 0; i < n; ++i)
            if (is_free[static_cast<std::size_t>(i)] ? w(i) < 0.0 : gradient(i) < -tolerance)
                wrong.push_back(i);
        if (wrong.empty()) return std::vector<double>(w.data(), w.data() + n);
        if (wrong.size() < fewest) {
            fewest = wrong.size();
            tries = full_exchanges;
        } else if (--tries < 0) {
            wrong = {wrong.back()};
        }
        for (const Eigen::Index i : wrong) is_free[static_cast<std::size_t>(i)].flip();
    }
    return failure(Reason::no_convergence, "the least-squares matrix is singular to working precision");
}

}  // namespace fidservo::calib
