// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/fleet/report/statistics/limited_sizes.h"

#include "src/fleet/report/statistics/censored.h"
#include "src/fleet/report/statistics/log_of_sum.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Dense>

namespace fidservo::fleet {
namespace {

/// The logarithm of a level's likelihood by its mean, and its first two derivatives, the second one negative.
struct LevelTerm {
    double log_likelihood, slope, curvature;
};

LevelTerm term_of(const Level& level, double mean, double variance) {
    const Moments given =
        level.named() ? Moments{level.value, 0.0} : moments_within(level.limit, mean, std::sqrt(variance));
    const double distance = level.value - mean;
    return {level.named()
                ? -0.5 * (std::log(2.0 * std::numbers::pi * variance) + distance * distance / variance)
                : log_within(level.limit, mean, std::sqrt(variance)),
            (given.mean - mean) / variance, (1.0 - given.variance / variance) / variance};
}

/// The largest product at one spread.
class AtOneSpread {
  public:
    AtOneSpread(std::span<const Level> levels, const TakenShares& taken, double spread)
        : levels_(levels),
          taken_(taken),
          spread_(spread),
          sizes_(Eigen::VectorXd::Zero(taken.columns.cols())) {
        constexpr int most_steps = 100, most_halvings = 30;
        constexpr double near = 1e-9;
        evaluate(sizes_);
        for (int step = 0; step < most_steps; ++step) {
            const Eigen::VectorXd from = sizes_;
            const double before = log_product_;
            Eigen::VectorXd by = precision_.llt().solve(slope_);
            for (int halving = 0; halving < most_halvings; ++halving, by *= 0.5) {
                evaluate(from + by);
                if (log_product_ >= before) break;
            }
            if (!(log_product_ >= before)) evaluate(from);
            if (log_product_ - before < near) break;
        }
    }

    /// log of the integral over the sizes, but for a constant.
    double log_integral() const {
        const Eigen::LLT<Eigen::MatrixXd> factor(precision_);
        double log_integral = log_product_;
        for (Eigen::Index j = 0; j < sizes_.size(); ++j) log_integral -= std::log(factor.matrixL()(j, j));
        return log_integral;
    }

    LimitedSizes sizes() const {
        LimitedSizes found{.sizes = {}, .spread = spread_, .log_likelihood = 0.0, .levels = {}};
        const Eigen::MatrixXd covariance =
            precision_.llt().solve(Eigen::MatrixXd::Identity(sizes_.size(), sizes_.size()));
        for (Eigen::Index j = 0; j < sizes_.size(); ++j)
            found.sizes.push_back({sizes_(j), std::sqrt(covariance(j, j))});
        const Eigen::VectorXd means = taken_.columns * sizes_;
        for (std::size_t u = 0; u < levels_.size(); ++u) {
            const Level& level = levels_[u];
            found.levels.push_back(level.named()
                                       ? level.value
                                       : moments_within(level.limit, means(static_cast<Eigen::Index>(u)),
                                                        std::hypot(level.std, spread_))
                                             .mean);
        }
        return found;
    }

  private:
    void evaluate(const Eigen::VectorXd& sizes) {
        sizes_ = sizes;
        const Eigen::VectorXd means = taken_.columns * sizes_;
        Eigen::VectorXd slopes(means.size()), curvatures(means.size());
        log_product_ = 0.0;
        for (Eigen::Index u = 0; u < means.size(); ++u) {
            const Level& level = levels_[static_cast<std::size_t>(u)];
            const LevelTerm term = term_of(level, means(u), level.std * level.std + spread_ * spread_);
            log_product_ += term.log_likelihood;
            slopes(u) = term.slope;
            curvatures(u) = term.curvature;
        }
        slope_ = taken_.columns.transpose() * slopes;
        precision_ = taken_.columns.transpose() * curvatures.asDiagonal() * taken_.columns;
        for (Eigen::Index j = 0; j < sizes_.size(); ++j) {
            const double law = taken_.laws[static_cast<std::size_t>(j)];
            log_product_ -= 0.5 * sizes_(j) * sizes_(j) / (law * law);
            slope_(j) -= sizes_(j) / (law * law);
            precision_(j, j) += 1.0 / (law * law);
        }
    }

    std::span<const Level> levels_;
    const TakenShares& taken_;
    double spread_, log_product_ = 0.0;
    Eigen::VectorXd sizes_, slope_;
    Eigen::MatrixXd precision_;  ///< of the sizes: minus the second derivatives
};

}  // namespace

LimitedSizes limited_sizes(std::span<const Level> levels, const TakenShares& taken) {
    double best = -std::numeric_limits<double>::infinity();
    LimitedSizes found;
    std::array<double, spread_count> terms{};
    for (std::size_t k = 0; k < spread_count; ++k) {
        const AtOneSpread at(levels, taken, spread_at(k));
        const double log_integral = at.log_integral();
        terms[k] = log_prior_of_spread(k) + log_integral;
        if (log_integral <= best) continue;
        best = log_integral;
        found = at.sizes();
    }
    found.log_likelihood = log_of_sum(terms);
    for (const double law : taken.laws) found.log_likelihood -= std::log(law);
    return found;
}

}  // namespace fidservo::fleet
