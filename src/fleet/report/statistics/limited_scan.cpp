// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/fleet/report/statistics/limited_scan.h"

#include "src/fleet/report/statistics/censored.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace fidservo::fleet {
namespace {

constexpr double step_of_std = 0.8;  // between nodes

/// Points, their variances, and what a change of size 1 adds to each.
struct ChangedPoints {
    std::span<const Point> points;
    std::span<const double> variances;
    std::vector<double> column;
};

/// The part of a change in the likelihood: points since it, by the level before.
class SinceChange {
  public:
    SinceChange(ChangedPoints since, std::span<const double> laws) : since_(std::move(since)), laws_(laws) {
        for (std::size_t t = 0; t < since_.points.size(); ++t) {
            const double weight = since_.column[t] / since_.variances[t];
            square_ += since_.column[t] * weight;
            product_ += weight * since_.points[t].value;
            weights_ += weight;
        }
        all_named_ = std::ranges::all_of(since_.points, &Point::named);
    }

    /// log of the integral over the size of the change.
    double log_integral(double level) const {
        const double product = product_ - level * weights_;
        if (all_named_) return log_at(level, 0.0) + log_mean_gain(product);
        const double step = step_of_std * std::min(1.0 / std::sqrt(square_), std::ranges::min(laws_));
        Nodes nodes = nodes_of(product / square_, step, [&](double size) { return log_at(level, size); });
        for (std::size_t k = 0; k < nodes.places.size(); ++k)
            nodes.log_weights[k] += log_density_of(nodes.places[k]);
        return nodes.log_integral();
    }

  private:
    double log_at(double level, double size) const {
        double sum = 0.0;
        for (std::size_t t = 0; t < since_.points.size(); ++t)
            sum += log_likelihood(since_.points[t], level + size * since_.column[t], since_.variances[t]);
        return sum;
    }

    /// Against no change, the size's law averaged over.
    double log_mean_gain(double product) const {
        std::vector<double> terms;
        for (const double law : laws_) {
            const double gain = law * law * square_;
            terms.push_back(-0.5 * std::log1p(gain) + 0.5 * product * product * law * law / (1.0 + gain));
        }
        return log_of_sum(terms) - std::log(static_cast<double>(laws_.size()));
    }

    double log_density_of(double size) const {
        std::vector<double> terms;
        for (const double law : laws_)
            terms.push_back(-0.5 * std::pow(size / law, 2) -
                            std::log(law * std::sqrt(2.0 * std::numbers::pi)));
        return log_of_sum(terms) - std::log(static_cast<double>(laws_.size()));
    }

    ChangedPoints since_;
    std::span<const double> laws_;
    double square_ = 0.0, product_ = 0.0, weights_ = 0.0;
    bool all_named_ = false;
};

/// Points with the variances that they have at one scale.
class AtScale {
  public:
    AtScale(std::span<const Point> points, const Scatter& scatter, double scale) : points_(points) {
        for (const Point& point : points) {
            variances_.push_back(scale * (point.std * point.std + scatter.std * scatter.std));
            weights_ += 1.0 / variances_.back();
        }
        unchanged_ = over_level(points, scatter.std * scatter.std, scale).log_integral();
    }

    double unchanged() const { return unchanged_; }

    double changed(const ChangeColumn& column, std::size_t first, std::span<const double> laws) const {
        const std::span<const double> variances = variances_;
        ChangedPoints changed{points_.subspan(first), variances.subspan(first), {}};
        for (const Point& point : changed.points) changed.column.push_back(column.at(point.time_weeks));
        const SinceChange since(std::move(changed), laws);
        const auto before = points_.first(first);
        const auto log_of = [&](double level) {
            double sum = since.log_integral(level);
            for (std::size_t t = 0; t < first; ++t) sum += log_likelihood(before[t], level, variances[t]);
            return sum;
        };
        return nodes_of(mean_of(first), step_of_std / std::sqrt(weights_), log_of).log_integral();
    }

  private:
    double mean_of(std::size_t count) const {
        double weights = 0.0, values = 0.0;
        for (std::size_t t = 0; t < count; ++t) {
            weights += 1.0 / variances_[t];
            values += points_[t].value / variances_[t];
        }
        return values / weights;
    }

    std::span<const Point> points_;
    std::vector<double> variances_;
    double weights_ = 0.0, unchanged_ = 0.0;
};

}  // namespace

ChangeScan scan_with_limits(std::span<const Point> points, const Scatter& scatter) {
    const auto scale_weights = log_weights_of_scales(scatter.degrees);
    std::vector<AtScale> at_scales;
    std::array<double, scatter_scales.size()> unchanged{};
    for (std::size_t j = 0; j < scatter_scales.size(); ++j) {
        at_scales.emplace_back(points, scatter, scatter_scales[j]);
        unchanged[j] = scale_weights[j] + at_scales.back().unchanged();
    }
    ChangeScan result(points.size());
    for (std::size_t k = 1; k < points.size(); ++k)
        for (const ChangeKind kind : {ChangeKind::step, ChangeKind::trend}) {
            const ChangeColumn column = column_of(kind, points, k);
            std::array<double, scatter_scales.size()> changed{};
            for (std::size_t j = 0; j < scatter_scales.size(); ++j)
                changed[j] = scale_weights[j] + at_scales[j].changed(column, k, laws_of(kind));
            const double log_ratio = log_of_sum(changed) - log_of_sum(unchanged);
            result.set(kind, k, log_ratio, log_ratio);
        }
    return result;
}

}  // namespace fidservo::fleet
