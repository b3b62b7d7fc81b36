// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/fleet/report/statistics/limited_scan.h"

#include "core/demand.h"
#include "src/fleet/report/statistics/censored.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace fidservo::fleet {
namespace {

/// The logarithm of a mean over the laws that the size of a change is drawn from.
template <class LogOfLaw>
double log_mean(std::span<const double> laws, const LogOfLaw& log_of) {
    std::array<double, 3> terms{};
    FIDSERVO_DEMAND(laws.size() == terms.size());
    std::ranges::transform(laws, terms.begin(), log_of);
    return log_of_sum(terms) - std::log(static_cast<double>(terms.size()));
}

/// What points since a change say, by the level before it, the size of the change integrated over.
class SinceChange {
  public:
    SinceChange(const LevelLikelihood& points, std::span<const double> laws) : points_(points), laws_(laws) {}

    double log_integral(double level) const {
        const Level rough = points_.rough_size(level);
        if (points_.all_named()) return points_.log_at(level) + log_mean_gain(rough);
        const double step = step_of_std * std::min(rough.std, std::ranges::min(laws_));
        return nodes_of(rough.value, step,
                        [&](double size) { return points_.log_at(level, size) + log_density_of(size); })
            .log_integral();
    }

  private:
    /// Against no change.
    double log_mean_gain(const Level& rough) const {
        const double square = 1.0 / (rough.std * rough.std), product = rough.value * square;
        return log_mean(laws_, [&](double law) {
            const double gain = law * law * square;
            return -0.5 * std::log1p(gain) + 0.5 * product * product * law * law / (1.0 + gain);
        });
    }

    double log_density_of(double size) const {
        return log_mean(laws_, [&](double law) {
            return -0.5 * std::pow(size / law, 2) - std::log(law * std::sqrt(2.0 * std::numbers::pi));
        });
    }

    const LevelLikelihood& points_;
    std::span<const double> laws_;
};

/// Points with the variances that they have at one scale.
class AtScale {
  public:
    AtScale(std::span<const Point> points, const Scatter& scatter, double scale) : points_(points) {
        double weights = 0.0;
        for (const Point& point : points) {
            variances_.push_back(scale * (point.std * point.std + scatter.std * scatter.std));
            weights += 1.0 / variances_.back();
        }
        step_ = step_of_std / std::sqrt(weights);
        unchanged_ = over_level(points, scatter.std * scatter.std, scale).log_integral();
    }

    double unchanged() const { return unchanged_; }

    double changed(const ChangeColumn& column, std::size_t first, std::span<const double> laws) const {
        LevelLikelihood before, since;
        for (std::size_t t = 0; t < first; ++t) before.add(points_[t], variances_[t]);
        for (std::size_t t = first; t < points_.size(); ++t)
            since.add(points_[t], variances_[t], column.at(points_[t].time_weeks));
        const SinceChange change(since, laws);
        return nodes_of(before.rough_level().value, step_,
                        [&](double level) { return before.log_at(level) + change.log_integral(level); })
            .log_integral();
    }

  private:
    std::span<const Point> points_;
    std::vector<double> variances_;
    double step_ = 0.0, unchanged_ = 0.0;
};

}  // namespace

ChangeScan scan_with_limits(std::span<const Point> points, const Scatter& scatter) {
    constexpr double nothing = -60.0;  // of a scale's weight
    const auto weights = log_weights_of_scales(scatter.degrees);
    std::vector<AtScale> at_scales;
    std::vector<double> log_weights, unchanged;
    for (std::size_t j = 0; j < weights.size(); ++j) {
        if (weights[j] < nothing) continue;
        at_scales.emplace_back(points, scatter, scatter_scales[j]);
        log_weights.push_back(weights[j]);
        unchanged.push_back(weights[j] + at_scales.back().unchanged());
    }
    ChangeScan result(points.size());
    for (std::size_t k = 1; k < points.size(); ++k)
        for (const ChangeKind kind : {ChangeKind::step, ChangeKind::trend}) {
            const ChangeColumn column = column_of(kind, points, k);
            std::vector<double> changed;
            for (std::size_t j = 0; j < at_scales.size(); ++j)
                changed.push_back(log_weights[j] + at_scales[j].changed(column, k, laws_of(kind)));
            const double log_ratio = log_of_sum(changed) - log_of_sum(unchanged);
            result.set(kind, k, log_ratio, log_ratio);
        }
    return result;
}

}  // namespace fidservo::fleet
