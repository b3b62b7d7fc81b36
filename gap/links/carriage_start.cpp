// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/links/carriage_start.h"

#include "gap/links/carriage_run.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>

namespace fidservo::gap {

namespace {

/// Standard deviation of the carriage's distance from its count. Within the count all positions are equally
/// good, even if a carriage at rest shows the same count a hundred times.
constexpr double noise_count = 0.05;
/// Standard deviations of the carried state: of the position by what rounding hides, of the velocity by a
/// distance of one count.
constexpr double place_std_count = 0.3, coast_std_count = 1.0;
constexpr double place_weight = 1.0 / (place_std_count * place_std_count);
constexpr double coast_weight = 1.0 / (coast_std_count * coast_std_count);

/// @param slope_of  how the error of a row changes with place and coast
template <class SlopeOf>
StartCorrection estimated_start(std::span<const double> error_count, const StartCorrection& done,
                                const SlopeOf& slope_of) {
    constexpr int most_steps = 20;  // what is not at the minimum then is within a fifth of a nat of it
    constexpr double enough_count = 1e-4;
    const double weight = 1.0 / (noise_count * noise_count);
    StartCorrection best = done, tried = done;
    double least = std::numeric_limits<double>::infinity();
    Eigen::Vector2d change = Eigen::Vector2d::Zero();
    for (int step = 0; step < most_steps; ++step) {
        const double place = tried.place_count - done.place_count;
        const double coast = tried.coast_count - done.coast_count;
        const Eigen::Vector2d prior(place_weight * tried.place_count, coast_weight * tried.coast_count);
        double loss = 0.5 * prior.dot(Eigen::Vector2d(tried.place_count, tried.coast_count));
        Eigen::Vector2d slope = prior;
        Eigen::Matrix2d curvature = Eigen::Vector2d(place_weight, coast_weight).asDiagonal();
        for (std::size_t k = 0; k < error_count.size(); ++k) {
            const auto [per_place, per_coast] = slope_of(k);
            const double excess = beyond_rounding(error_count[k] + per_place * place + per_coast * coast);
            if (excess == 0.0) continue;
            loss += 0.5 * weight * excess * excess;
            slope += weight * excess * Eigen::Vector2d(per_place, per_coast);
            curvature(0, 0) += weight * per_place * per_place;
            curvature(0, 1) += weight * per_place * per_coast;
            curvature(1, 1) += weight * per_coast * per_coast;
        }
        if (loss < least) {
            least = loss;
            best = tried;
            curvature(1, 0) = curvature(0, 1);
            change = curvature.inverse() * slope;
        } else {
            change *= 0.5;
        }
        if (change.cwiseAbs().maxCoeff() < enough_count) break;
        tried = {best.place_count - change.x(), best.coast_count - change.y()};
    }
    return best;
}

}  // namespace

double start_loss(std::span<const double> error_count, const StartCorrection& done) {
    double loss = 0.5 * (place_weight * done.place_count * done.place_count +
                         coast_weight * done.coast_count * done.coast_count);
    for (const double error : error_count) {
        const double excess = beyond_rounding(error) / noise_count;
        loss += 0.5 * excess * excess;
    }
    return loss;
}

StartCorrection estimate_start(std::span<const double> error_count, const StartCorrection& done,
                               double ticks_per_tau) {
    const double decay = std::exp(-1.0 / ticks_per_tau);
    std::vector<double> covered;
    covered.reserve(error_count.size());
    double left = 1.0;
    for (std::size_t k = 0; k < error_count.size(); ++k) {
        covered.push_back(1.0 - left);
        left *= decay;
    }
    return estimated_start(error_count, done, [&](std::size_t k) { return StartSlope{1.0, covered[k]}; });
}

StartCorrection estimate_start(std::span<const double> error_count, const StartCorrection& done,
                               std::span<const StartSlope> slopes) {
    return estimated_start(error_count, done, [&](std::size_t k) { return slopes[k]; });
}

}  // namespace fidservo::gap
