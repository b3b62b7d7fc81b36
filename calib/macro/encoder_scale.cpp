// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/macro/encoder_scale.h"

#include "calib/rounding_likelihood.h"
#include "core/failure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <Eigen/Dense>
#include <fmt/format.h>

namespace fidservo::calib {

namespace {

constexpr std::size_t least_stands = 4;
constexpr double least_counts = 20.0;
constexpr double least_noise_beside_rounding_count = 2e-4;
constexpr double reach_in_noise = 6.0;  ///< beyond a count's edge nothing is left of the likelihood

/// Stands about their middle: c = slope way + offset.
struct Stands {
    Eigen::ArrayXd way_mm, count;
    double noise_count = 0.0;
};

struct Interval {
    double low, high;
    double width() const { return high - low; }
};

/// Offsets that put every stand inside its count, at a slope; of negative width if there are none.
Interval offsets_at(const Stands& stands, double slope) {
    const Eigen::ArrayXd middle = stands.count - slope * stands.way_mm;
    return {(middle - 0.5).maxCoeff(), (middle + 0.5).minCoeff()};
}

/// The slope with the widest interval, which is concave in it: ternary search.
double widest_slope(const Stands& stands, double from, double to) {
    constexpr int steps = 120;
    for (int step = 0; step < steps; ++step) {
        const double a = from + (to - from) / 3.0, b = to - (to - from) / 3.0;
        if (offsets_at(stands, a).width() < offsets_at(stands, b).width())
            from = a;
        else
            to = b;
    }
    return 0.5 * (from + to);
}

/// Where the interval's width falls below a bound, from `inside` in steps of growing size.
double edge_slope(const Stands& stands, double inside, double step, double least_width) {
    double low = 0.0, high = step;
    while (offsets_at(stands, inside + high).width() > least_width) high *= 2.0;
    constexpr int halvings = 60;
    for (int k = 0; k < halvings; ++k) {
        const double middle = 0.5 * (low + high);
        (offsets_at(stands, inside + middle).width() > least_width ? low : high) = middle;
    }
    return inside + high;
}

struct Posterior {
    double slope = 0.0, offset = 0.0;
    Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
};

double log_likelihood(const Stands& stands, double slope, double offset) {
    double sum = 0.0;
    for (Eigen::Index i = 0; i < stands.count.size(); ++i)
        sum -= rounding_loss(slope * stands.way_mm(i) + offset - stands.count(i), stands.noise_count).value;
    return sum;
}

Posterior integrate(const Stands& stands, double best_slope, double least_step) {
    constexpr int slopes = 100, offsets = 60;
    const double margin = reach_in_noise * stands.noise_count;
    const double least_width = std::min(-2.0 * margin, offsets_at(stands, best_slope).width() - 2.0 * margin);
    const double low = edge_slope(stands, best_slope, -least_step, least_width);
    const double high = edge_slope(stands, best_slope, least_step, least_width);
    struct Point {
        double slope, offset, log, cell;
    };
    std::vector<Point> points;
    points.reserve(static_cast<std::size_t>(slopes) * offsets);
    double highest = -std::numeric_limits<double>::infinity();
    for (int i = 0; i < slopes; ++i) {
        const double slope = low + (high - low) * (i + 0.5) / slopes;
        const Interval inside = offsets_at(stands, slope);
        const double middle = 0.5 * (inside.low + inside.high);
        const double half = 0.5 * std::abs(inside.width()) + margin;
        for (int j = 0; j < offsets; ++j) {
            const double offset = middle + half * (2.0 * (j + 0.5) / offsets - 1.0);
            points.push_back({slope, offset, log_likelihood(stands, slope, offset), half});
            highest = std::max(highest, points.back().log);
        }
    }
    double mass = 0.0;
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    Eigen::Matrix2d moment = Eigen::Matrix2d::Zero();
    const Eigen::Vector2d about(best_slope, points.front().offset);
    for (const Point& point : points) {
        const double weight = point.cell * std::exp(point.log - highest);
        const Eigen::Vector2d from = Eigen::Vector2d(point.slope, point.offset) - about;
        mass += weight;
        mean += weight * from;
        moment += weight * from * from.transpose();
    }
    mean /= mass;
    return {about.x() + mean.x(), about.y() + mean.y(), moment / mass - mean * mean.transpose()};
}

/// Mean square of the places within their counts over that of evenly spread ones, at least 1. It is 3 where
/// all are at edges, and the true line then is at the rim of what the counts allow, not anywhere inside.
double crowding(const Stands& stands, const Posterior& line) {
    const Eigen::ArrayXd within = line.slope * stands.way_mm + line.offset - stands.count;
    const double even = 1.0 / 12.0 + stands.noise_count * stands.noise_count;
    return std::max(1.0, within.square().mean() / even);
}

/// Variances that a likelihood of evenly spread places does not know of: where places pile up at the edges of
/// their counts, their noise shifts the line, as it does a least-squares line. Noise of a count's size smears
/// edges out, as dither does (the rounding's first harmonic).
Eigen::Matrix2d of_edges(const Stands& stands) {
    constexpr double pi = std::numbers::pi;
    const double noise = stands.noise_count;
    const double variance = std::pow(noise * std::exp(-2.0 * pi * pi * noise * noise), 2.0) /
                            static_cast<double>(stands.count.size());
    return Eigen::Vector2d(variance / stands.way_mm.square().mean(), variance).asDiagonal();
}

}  // namespace

Result<EncoderScale> fit_encoder_scale(std::span<const EncoderStand> stands) {
    const auto n = static_cast<Eigen::Index>(stands.size());
    if (stands.size() < least_stands)
        return failure(Reason::not_identifiable,
                       fmt::format("{} stands of the carriage: {} are needed", stands.size(), least_stands));
    Stands data{Eigen::ArrayXd(n), Eigen::ArrayXd(n), 0.0};
    double variance_mm2 = 0.0;
    for (Eigen::Index i = 0; i < n; ++i) {
        const EncoderStand& stand = stands[static_cast<std::size_t>(i)];
        data.way_mm(i) = stand.carriage_mm;
        data.count(i) = stand.count;
        variance_mm2 += stand.std_mm * stand.std_mm / static_cast<double>(n);
    }
    const double counts = data.count.maxCoeff() - data.count.minCoeff();
    if (counts < least_counts)
        return failure(
            Reason::not_identifiable,
            fmt::format("the carriage moved over {:.0f} counts: {:.0f} are needed", counts, least_counts));
    const double middle_mm = data.way_mm.mean();
    data.way_mm -= middle_mm;
    const double way_mm = data.way_mm.maxCoeff() - data.way_mm.minCoeff();
    const double rough = (data.way_mm * data.count).sum() / data.way_mm.square().sum();
    const double slack = 4.0 / way_mm;  // two counts at either end
    const double best = widest_slope(data, rough - slack, rough + slack);
    data.noise_count = std::max(least_noise_beside_rounding_count, std::sqrt(variance_mm2) * std::abs(best));

    EncoderScale scale{};
    scale.excess_count = std::max(0.0, -0.5 * offsets_at(data, best).width());
    // The worst of n stands leaves its count by some three standard deviations at most.
    constexpr double largest_in_noise = 3.5;
    scale.fits = scale.excess_count <= largest_in_noise * data.noise_count;
    if (!scale.fits) data.noise_count = scale.excess_count / 2.0;
    Posterior posterior = integrate(data, best, 0.01 / way_mm);
    posterior.covariance = crowding(data, posterior) * posterior.covariance + of_edges(data);
    const double p = 1.0 / posterior.slope;
    scale.resolution_mm = p;
    scale.resolution_std_mm = p * p * std::sqrt(posterior.covariance(0, 0));
    scale.middle_mm = middle_mm;
    scale.middle_std_mm = std::abs(p) * std::sqrt(posterior.covariance(1, 1));
    // zero = middle - offset / slope
    const Eigen::Vector2d to_zero(posterior.offset * p * p, -p);
    scale.zero_mm = middle_mm - posterior.offset * p;
    scale.zero_std_mm = std::sqrt(to_zero.dot(posterior.covariance * to_zero));
    return scale;
}

}  // namespace fidservo::calib
