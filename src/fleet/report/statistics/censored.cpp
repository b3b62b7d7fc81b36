// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/fleet/report/statistics/censored.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fidservo::fleet {
namespace {

constexpr double far_out = 25.0;  // std: beyond, a tail's probability is told by its asymptotic series

/// log P(x > z) of the standard normal law, z >= 0.
double log_tail(double z) {
    if (z < far_out) return std::log(0.5 * std::erfc(z / std::numbers::sqrt2));
    return -0.5 * z * z - std::log(z * std::sqrt(2.0 * std::numbers::pi)) - 1.0 / (z * z);
}

double log_normal(double distance, double variance) {
    return -0.5 * (std::log(2.0 * std::numbers::pi * variance) + distance * distance / variance);
}

}  // namespace

double log_within(double limit, double mean, double std) {
    const double near = (limit - std::abs(mean)) / std, far = (limit + std::abs(mean)) / std;
    if (near >= 0.0)
        return std::log1p(-0.5 * std::erfc(near / std::numbers::sqrt2) -
                          0.5 * std::erfc(far / std::numbers::sqrt2));
    const double log_near = log_tail(-near);
    return log_near + std::log1p(-std::exp(log_tail(far) - log_near));
}

Moments moments_within(double limit, double mean, double std) {
    const double low = (-limit - mean) / std, high = (limit - mean) / std;
    const double log_all = log_within(limit, mean, std);
    const auto density = [&](double z) { return std::exp(log_normal(z, 1.0) - log_all); };
    const double at_low = density(low), at_high = density(high), shift = at_low - at_high;
    const double variance = 1.0 + low * at_low - high * at_high - shift * shift;
    return {mean + std * shift, std * std * std::max(0.0, variance)};
}

void LevelLikelihood::add(const Point& point, double variance, double column) {
    const double weight = 1.0 / variance;
    weights_ += weight;
    product_ += weight * point.value;
    column_weights_ += weight * column;
    column_squares_ += weight * column * column;
    column_product_ += weight * column * point.value;
    if (point.named()) {
        named_ += weight;
        named_product_ += weight * point.value;
        named_column_ += weight * column;
        named_column_square_ += weight * column * column;
        named_column_product_ += weight * column * point.value;
        named_square_ += weight * point.value * point.value;
        log_factors_ += log_normal(0.0, variance);
        return;
    }
    const double std = std::sqrt(variance);
    const auto alike = std::ranges::find_if(unseen_, [&](const Unseen& one) {
        return one.limit == point.limit && one.std == std && one.column == column;
    });
    if (alike != unseen_.end())
        alike->count += 1.0;
    else
        unseen_.push_back({point.limit, std, column, 1.0});
}

double LevelLikelihood::log_at(double level, double size) const {
    const double squares = named_square_ - 2.0 * (level * named_product_ + size * named_column_product_) +
                           level * level * named_ + 2.0 * level * size * named_column_ +
                           size * size * named_column_square_;
    double sum = log_factors_ - 0.5 * squares;
    for (const Unseen& one : unseen_)
        sum += one.count * log_within(one.limit, level + size * one.column, one.std);
    return sum;
}

Level LevelLikelihood::rough_size(double level) const {
    return {(column_product_ - level * column_weights_) / column_squares_, 1.0 / std::sqrt(column_squares_)};
}

Nodes over_level(std::span<const Point> points, double extra_variance, double times) {
    LevelLikelihood likelihood;
    for (const Point& point : points) likelihood.add(point, times * (point.std * point.std + extra_variance));
    const Level rough = likelihood.rough_level();
    return nodes_of(rough.value, step_of_std * rough.std,
                    [&](double level) { return likelihood.log_at(level); });
}

Level as_normal(const Level& level) {
    return {level.value,
            level.named() ? level.std : std::hypot(level.std, level.limit / std::numbers::sqrt3)};
}

Point as_normal(const Point& point) {
    const Level level = as_normal(Level{point.value, point.std, point.limit});
    return {point.time_weeks, level.value, level.std};
}

}  // namespace fidservo::fleet
