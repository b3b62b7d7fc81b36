// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/design/discrimination.h"

#include "core/parallel.h"
#include "gap/fit/score.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Cholesky>

namespace fidservo::design {
namespace {

double mean_square(const WindowProducts& window, const Eigen::VectorXd& step) {
    const Eigen::Index width = step.size();
    Eigen::VectorXd with_error(width + 1);
    with_error << step, 1.0;
    return std::max(0.0, with_error.dot(window.products * with_error)) / window.count;
}

double loss_at(std::span<const WindowProducts> windows, const Eigen::VectorXd& zero,
               const Eigen::VectorXd& step) {
    double loss = 0.5 * (zero + step).squaredNorm();
    for (const WindowProducts& window : windows) loss += gap::window_loss(mean_square(window, step));
    return loss;
}

/// An explanation's predictions of a recording.
class Adjustment {
  public:
    Adjustment(const gap::Evidence& evidence, const Explanation& rival)
        : evidence_(evidence),
          rival_(rival),
          wanted_(gap::everything(evidence)),
          z_(Eigen::VectorXd::Zero(rival.spread.cols())),
          errors_(predicted(z_)) {
        loss_ = loss_of(z_, errors_);
    }

    bool can_predict() const { return !errors_.empty(); }
    double loss() const { return loss_; }
    const Eigen::VectorXd& z() const { return z_; }

    /// What slopes at z say that can be reached.
    Adjusted foreseen() const {
        constexpr double secant = 0.5;
        std::vector<gap::Errors> slopes(static_cast<std::size_t>(z_.size()));
        parallel_for(slopes.size(), [&](std::size_t k) {
            Eigen::VectorXd beside = z_;
            beside(static_cast<Eigen::Index>(k)) += secant;
            slopes[k] = predicted(beside);
            if (slopes[k].empty()) slopes[k] = errors_;
            for (std::size_t i = 0; i < errors_.size(); ++i)
                slopes[k][i] = (slopes[k][i] - errors_[i]) / static_cast<float>(secant);
        });
        return adjusted(products_of(evidence_.windows(), errors_, slopes), z_);
    }

    /// Goes there, or as far towards it as that becomes better. @return whether it did
    bool go(const Eigen::VectorXd& z) {
        constexpr int most_halvings = 3;
        constexpr double least_gain = 1e-3;
        Eigen::VectorXd step = z - z_;
        for (int halving = 0; halving <= most_halvings; ++halving, step *= 0.5) {
            const Eigen::VectorXd there = z_ + step;
            gap::Errors errors = predicted(there);
            const double loss = loss_of(there, errors);
            if (!(loss < loss_ - least_gain)) continue;
            z_ = there;
            errors_ = std::move(errors);
            loss_ = loss;
            return true;
        }
        return false;
    }

  private:
    gap::Errors predicted(const Eigen::VectorXd& z) const {
        return evidence_.errors(moved(rival_, z), wanted_);
    }

    double loss_of(const Eigen::VectorXd& z, const gap::Errors& errors) const {
        return gap::total_loss(evidence_.windows(), wanted_, errors) + 0.5 * z.squaredNorm();
    }

    const gap::Evidence& evidence_;
    const Explanation& rival_;
    gap::Wanted wanted_;
    Eigen::VectorXd z_;
    gap::Errors errors_;
    double loss_ = std::numeric_limits<double>::infinity();
};

void improve(Adjustment& adjustment, int iterations) {
    for (int k = 0; k < iterations; ++k)
        if (!adjustment.go(adjustment.foreseen().z)) break;
}

}  // namespace

std::vector<WindowProducts> products_of(std::span<const gap::Window> windows, const gap::Errors& errors,
                                        std::span<const gap::Errors> slopes) {
    const auto width = static_cast<Eigen::Index>(slopes.size());
    std::vector<WindowProducts> all;
    for (const gap::Window& window : windows) {
        Eigen::MatrixXd rows(window.end - window.begin, width + 1);
        Eigen::Index count = 0;
        for (std::size_t row = window.begin; row < window.end; ++row) {
            if (!std::isfinite(errors[row])) continue;
            for (Eigen::Index k = 0; k < width; ++k) {
                const float change = slopes[static_cast<std::size_t>(k)][row];
                rows(count, k) = std::isfinite(change) ? change : 0.0F;
            }
            rows(count++, width) = errors[row];
        }
        if (count == 0) continue;
        all.push_back({static_cast<double>(count), rows.topRows(count).transpose() * rows.topRows(count)});
    }
    return all;
}

Adjusted adjusted(std::span<const WindowProducts> windows, const Eigen::VectorXd& zero) {
    constexpr int most_iterations = 30;
    constexpr double least_gain = 1e-9;  // relative
    const Eigen::Index width = zero.size();
    Eigen::VectorXd step = Eigen::VectorXd::Zero(width);
    double loss = loss_at(windows, zero, step);
    for (int iteration = 0; width > 0 && iteration < most_iterations; ++iteration) {
        // The logarithm lies below its tangent in S: the least of that, a sum of squares, never does worse.
        Eigen::MatrixXd normal = Eigen::MatrixXd::Identity(width, width);
        Eigen::VectorXd right = -zero;
        for (const WindowProducts& window : windows) {
            const double weight = 1.0 / (window.count * (1.0 + mean_square(window, step)));
            normal += weight * window.products.topLeftCorner(width, width);
            right -= weight * window.products.topRightCorner(width, 1);
        }
        const Eigen::VectorXd next = normal.ldlt().solve(right);
        const double reached = loss_at(windows, zero, next);
        if (!(reached < loss * (1.0 - least_gain))) break;
        step = next;
        loss = reached;
    }
    return {zero + step, loss};
}

double log_odds(const gap::Evidence& evidence, const gap::Hypothesis& truth, const Explanation& rival,
                int iterations) {
    const gap::Wanted wanted = gap::everything(evidence);
    const double least = gap::total_loss(evidence.windows(), wanted, evidence.errors(truth, wanted));
    Adjustment adjustment(evidence, rival);
    if (!adjustment.can_predict() || !std::isfinite(least)) return 0.0;
    if (iterations == 1) return adjustment.foreseen().loss - least;
    improve(adjustment, iterations);
    return adjustment.loss() - least;
}

gap::Hypothesis adjusted_to(const gap::Evidence& evidence, const Explanation& rival, int iterations) {
    Adjustment adjustment(evidence, rival);
    improve(adjustment, iterations);
    return moved(rival, adjustment.z());
}

}  // namespace fidservo::design
