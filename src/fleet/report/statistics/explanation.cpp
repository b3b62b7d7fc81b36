// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/fleet/report/statistics/explanation.h"

#include "src/fleet/report/statistics/log_of_sum.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include <Eigen/Dense>

namespace fidservo::fleet {
namespace {

AtSpread at_spread(std::span<const Level> levels, const TakenShares& taken, double spread) {
    AtSpread at;
    const auto units = static_cast<Eigen::Index>(levels.size());
    at.weights.resize(units);
    Eigen::VectorXd values(units);
    double log_determinant = 0.0;
    for (Eigen::Index u = 0; u < units; ++u) {
        const Level& level = levels[static_cast<std::size_t>(u)];
        at.weights(u) = 1.0 / (level.std * level.std + spread * spread);
        values(u) = level.value;
        log_determinant -= std::log(at.weights(u));
    }
    const auto shares = static_cast<Eigen::Index>(taken.laws.size());
    Eigen::MatrixXd precision = taken.columns.transpose() * at.weights.asDiagonal() * taken.columns;
    for (Eigen::Index j = 0; j < shares; ++j) {
        const double law = taken.laws[static_cast<std::size_t>(j)];
        precision(j, j) += 1.0 / (law * law);
        log_determinant += 2.0 * std::log(law);
    }
    const Eigen::LLT<Eigen::MatrixXd> factor(precision);
    for (Eigen::Index j = 0; j < shares; ++j) log_determinant += 2.0 * std::log(factor.matrixL()(j, j));
    const Eigen::VectorXd weighted = at.weights.cwiseProduct(values);
    const Eigen::VectorXd products = taken.columns.transpose() * weighted;
    at.covariance = factor.solve(Eigen::MatrixXd::Identity(shares, shares));
    at.sizes = at.covariance * products;
    at.left = values - taken.columns * at.sizes;
    at.log_likelihood = -0.5 * (log_determinant + values.dot(weighted) - products.dot(at.sizes));
    return at;
}

}  // namespace

double spread_at(std::size_t k) {
    constexpr double least = 0.05, ratio = 1.413;
    return k == 0 ? 0.0 : least * std::pow(ratio, static_cast<double>(k - 1));
}

double log_prior_of_spread(std::size_t k) {
    return k == 0 ? std::log(0.5) : std::log(0.5 / static_cast<double>(spread_count - 1));
}

void TakenShares::take(std::span<const std::size_t> units, double law) {
    const Eigen::Index last = columns.cols();
    columns.conservativeResize(Eigen::NoChange, last + 1);
    columns.col(last).setZero();
    for (const std::size_t u : units) columns(static_cast<Eigen::Index>(u), last) = 1.0;
    laws.push_back(law);
}

void FurtherColumn::add(const AtSpread& at, const TakenShares& taken, std::size_t unit) {
    const auto u = static_cast<Eigen::Index>(unit);
    square_ += at.weights(u);
    product_ += at.weights(u) * at.left(u);
    shared_ += at.weights(u) * taken.columns.row(u).transpose();
}

double FurtherColumn::log_gain(const AtSpread& at, double law) const {
    const double square = std::max(0.0, square_ - shared_.dot(at.covariance * shared_));
    const double gain = law * law * square;
    return -0.5 * std::log1p(gain) + 0.5 * product_ * product_ * law * law / (1.0 + gain);
}

Explanation::Explanation(std::span<const Level> levels) : levels_(levels), taken_(levels.size()) {
    fit();
}

WithFurther Explanation::averaged(const Terms& terms) const {
    std::array<double, share_laws.size()> of_laws{};
    std::ranges::transform(terms, of_laws.begin(), [](const auto& of_law) { return log_of_sum(of_law); });
    const auto best = static_cast<std::size_t>(std::ranges::max_element(of_laws) - of_laws.begin());
    return {log_of_sum(of_laws) - std::log(static_cast<double>(share_laws.size())), share_laws[best]};
}

WithFurther Explanation::with(std::span<const std::size_t> units) const {
    Terms terms{};
    for (std::size_t s = 0; s < spread_count; ++s) {
        FurtherColumn column(taken_.columns.cols());
        for (const std::size_t unit : units) column.add(at_[s], taken_, unit);
        const double so_far = log_prior_of_spread(s) + at_[s].log_likelihood;
        for (std::size_t k = 0; k < share_laws.size(); ++k)
            terms[k][s] = so_far + column.log_gain(at_[s], share_laws[k]);
    }
    return averaged(terms);
}

std::vector<WithFurther> Explanation::with_first_of(std::span<const std::size_t> units) const {
    std::vector<Terms> terms(units.size());
    for (std::size_t s = 0; s < spread_count; ++s) {
        FurtherColumn column(taken_.columns.cols());
        const double so_far = log_prior_of_spread(s) + at_[s].log_likelihood;
        for (std::size_t count = 0; count < units.size(); ++count) {
            column.add(at_[s], taken_, units[count]);
            for (std::size_t k = 0; k < share_laws.size(); ++k)
                terms[count][k][s] = so_far + column.log_gain(at_[s], share_laws[k]);
        }
    }
    std::vector<WithFurther> further;
    further.reserve(terms.size());
    for (const Terms& of_count : terms) further.push_back(averaged(of_count));
    return further;
}

void Explanation::take(std::span<const std::size_t> units, double law) {
    taken_.take(units, law);
    fit();
}

std::vector<std::size_t> Explanation::by_what_is_left() const {
    const AtSpread& likeliest = *std::ranges::max_element(at_, {}, &AtSpread::log_likelihood);
    std::vector<std::size_t> order(levels_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, std::greater{},
                             [&](std::size_t u) { return likeliest.left(static_cast<Eigen::Index>(u)); });
    return order;
}

void Explanation::fit() {
    at_.clear();
    std::array<double, spread_count> terms{};
    for (std::size_t s = 0; s < spread_count; ++s) {
        at_.push_back(at_spread(levels_, taken_, spread_at(s)));
        terms[s] = log_prior_of_spread(s) + at_.back().log_likelihood;
    }
    log_likelihood_ = log_of_sum(terms);
}

}  // namespace fidservo::fleet
