// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/fleet/report/statistics/censored.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

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

/// Diagnoses that do not name the quantity, alike in limit and error.
struct Unseen {
    double limit, std, count;
};

void count_in(std::vector<Unseen>& unseen, double limit, double std) {
    for (Unseen& one : unseen)
        if (one.limit == limit && one.std == std) {
            one.count += 1.0;
            return;
        }
    unseen.push_back({limit, std, 1.0});
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

double log_likelihood(const Point& point, double theta, double variance) {
    return point.named() ? log_normal(point.value - theta, variance)
                         : log_within(point.limit, theta, std::sqrt(variance));
}

Nodes over_level(std::span<const Point> points, double extra_variance, double times) {
    constexpr double step_of_std = 0.8;
    double start = 0.0, weights = 0.0;
    for (const Point& point : points) {
        const double weight = 1.0 / (times * (point.std * point.std + extra_variance));
        start += weight * point.value;
        weights += weight;
    }
    start /= weights;
    // Those that are named are a parabola; those of one limit and error are one factor to the power of their
    // number.
    double named = 0.0, slope = 0.0, at_start = 0.0;
    std::vector<Unseen> unseen;
    for (const Point& point : points) {
        const double variance = times * (point.std * point.std + extra_variance);
        if (!point.named()) {
            count_in(unseen, point.limit, std::sqrt(variance));
            continue;
        }
        named += 1.0 / variance;
        slope += (point.value - start) / variance;
        at_start += log_normal(point.value - start, variance);
    }
    return nodes_of(start, step_of_std / std::sqrt(weights), [&](double level) {
        const double from_start = level - start;
        double sum = at_start + from_start * (slope - 0.5 * from_start * named);
        for (const Unseen& one : unseen) sum += one.count * log_within(one.limit, level, one.std);
        return sum;
    });
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
