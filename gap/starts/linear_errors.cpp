// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/starts/linear_errors.h"

#include "core/parallel.h"
#include "gap/fit/minimum_norm.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace fidservo::gap {
namespace {

double inner_product(const Window& window, const Errors& one, const Errors& other) {
    const auto in_window = [&](const Errors& errors) {
        return Eigen::Map<const Eigen::VectorXf>(errors.data() + window.begin,
                                                 static_cast<Eigen::Index>(window.end - window.begin))
            .cast<double>();
    };
    return in_window(one).dot(in_window(other));
}

}  // namespace

LinearErrors::LinearErrors(std::span<const Window> windows, const Errors& errors, std::vector<Errors> changes)
    : windows_(windows), errors_(errors), changes_(std::move(changes)), products_(windows.size()) {
    counts_.reserve(errors.size());
    for (float& error : errors_) {
        counts_.push_back(!std::isnan(error));
        if (std::isnan(error)) error = 0.0F;
    }
    for (const Window& window : windows)
        numbers_.push_back(
            static_cast<double>(std::count(counts_.begin() + static_cast<std::ptrdiff_t>(window.begin),
                                           counts_.begin() + static_cast<std::ptrdiff_t>(window.end), true)));
    for (Errors& change : changes_) leave_out_what_does_not_count(change);
    parallel_for(windows.size(), [&](std::size_t w) {
        std::vector<const Errors*> columns;
        columns.reserve(changes_.size() + 1);
        for (const Errors& change : changes_) columns.push_back(&change);
        columns.push_back(&errors_);
        Eigen::MatrixXd products(size() + 1, size() + 1);
        for (Eigen::Index i = 0; i <= size(); ++i)
            for (Eigen::Index k = 0; k <= i; ++k)
                products(i, k) = products(k, i) = inner_product(
                    windows[w], *columns[static_cast<std::size_t>(i)], *columns[static_cast<std::size_t>(k)]);
        products_[w] = std::move(products);
    });
}

LinearErrors::Optimum LinearErrors::optimum(const Wanted& counted, std::vector<Errors> further) const {
    for (Errors& change : further) leave_out_what_does_not_count(change);
    const auto more = static_cast<Eigen::Index>(further.size());
    const Eigen::Index known = size(), width = known + more;
    std::vector<Eigen::MatrixXd> products(windows_.size());
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(width, width);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(width);
    for (std::size_t w = 0; w < windows_.size(); ++w) {
        if (counted[w] == 0 || numbers_[w] == 0.0) continue;
        const Eigen::MatrixXd& own = products_[w];
        Eigen::MatrixXd all(width + 1, width + 1);
        all.topLeftCorner(known, known) = own.topLeftCorner(known, known);
        all.col(width).head(known) = own.col(known).head(known);
        all.row(width).head(known) = own.row(known).head(known);
        all(width, width) = own(known, known);
        for (Eigen::Index i = 0; i < more; ++i) {
            const Errors& change = further[static_cast<std::size_t>(i)];
            const auto set = [&](Eigen::Index k, const Errors& other) {
                all(k, known + i) = all(known + i, k) = inner_product(windows_[w], change, other);
            };
            for (Eigen::Index k = 0; k < known; ++k) set(k, changes_[static_cast<std::size_t>(k)]);
            for (Eigen::Index k = 0; k <= i; ++k) set(known + k, further[static_cast<std::size_t>(k)]);
            set(width, errors_);
        }
        const double weight = 1.0 / (numbers_[w] + all(width, width));
        normal += weight * all.topLeftCorner(width, width);
        right -= weight * all.col(width).head(width);
        products[w] = std::move(all);
    }
    Optimum optimum{minimum_norm_solution(normal, right),
                    std::vector(windows_.size(), std::numeric_limits<double>::quiet_NaN())};
    for (std::size_t w = 0; w < windows_.size(); ++w) {
        if (products[w].size() == 0) continue;
        Eigen::VectorXd weights(width + 1);
        weights << optimum.shares, 1.0;
        optimum.mean_squares[w] = std::max(0.0, weights.dot(products[w] * weights)) / numbers_[w];
    }
    return optimum;
}

void LinearErrors::leave_out_what_does_not_count(Errors& change) const {
    for (std::size_t row = 0; row < change.size(); ++row)
        if (!counts_[row] || !std::isfinite(change[row])) change[row] = 0.0F;
}

}  // namespace fidservo::gap
