// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/fleet/report/statistics/within_scatter.h"

#include "src/fleet/report/statistics/censored.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

namespace fidservo::fleet {
namespace {

/// Degrees of freedom that are looked at. The last is as good as a scale that all units share.
constexpr std::array scale_degrees{2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0, 24.0, 32.0, 64.0, 128.0, 1e5};
constexpr std::size_t sigma_count = 27;
constexpr double least_contrasts = 10.0;

/// 0, and from 0.02 floors on in steps of a third up to 36.
double sigma_at(std::size_t k) {
    constexpr double first = 0.02, ratio = 1.35;
    return k == 0 ? 0.0 : first * std::pow(ratio, static_cast<double>(k - 1));
}

/// Of a unit that some diagnoses name and others do not.
std::vector<double> log_likelihoods_with_limits(const std::vector<Point>& points) {
    constexpr std::size_t scale_count = scatter_scales.size();
    std::array<std::array<double, scale_count>, scale_degrees.size()> weights{};
    std::ranges::transform(scale_degrees, weights.begin(), log_weights_of_scales);
    std::vector<double> over_grid;
    for (std::size_t k = 0; k < sigma_count; ++k) {
        const double sigma = sigma_at(k);
        std::array<double, scale_count> of_scale{};
        std::ranges::transform(scatter_scales, of_scale.begin(), [&](double scale) {
            return over_level(points, sigma * sigma, scale).log_integral();
        });
        for (const auto& of_degrees : weights) {
            std::array<double, scale_count> terms{};
            std::ranges::transform(of_scale, of_degrees, terms.begin(), std::plus{});
            over_grid.push_back(log_of_sum(terms));
        }
    }
    return over_grid;
}

std::vector<double> log_likelihoods(const std::vector<Point>& points) {
    std::vector<double> over_grid(sigma_count * scale_degrees.size(), 0.0);
    const double contrasts = static_cast<double>(points.size()) - 1.0;
    std::array<double, scale_degrees.size()> constant{};
    for (std::size_t d = 0; d < scale_degrees.size(); ++d) {
        const double nu = scale_degrees[d];
        constant[d] = std::lgamma(0.5 * (nu + contrasts)) - std::lgamma(0.5 * nu) -
                      0.5 * contrasts * std::log(std::numbers::pi * nu);
    }
    for (std::size_t k = 0; k < sigma_count; ++k) {
        const double sigma = sigma_at(k);
        double weights = 0.0, weighted = 0.0, log_variances = 0.0;
        for (const Point& point : points) {
            const double variance = point.std * point.std + sigma * sigma;
            weights += 1.0 / variance;
            weighted += point.value / variance;
            log_variances += std::log(variance);
        }
        const double mean = weighted / weights;
        double squares = 0.0;
        for (const Point& point : points)
            squares += (point.value - mean) * (point.value - mean) / (point.std * point.std + sigma * sigma);
        const double common = -0.5 * log_variances - 0.5 * std::log(weights);
        for (std::size_t d = 0; d < scale_degrees.size(); ++d)
            over_grid[k * scale_degrees.size() + d] =
                constant[d] + common -
                0.5 * (scale_degrees[d] + contrasts) * std::log1p(squares / scale_degrees[d]);
    }
    return over_grid;
}

/// The sigma that is likeliest with degrees of freedom, those of the grid next below them.
double likeliest_sigma(const std::vector<double>& over_grid, double degrees) {
    const auto above = std::ranges::upper_bound(scale_degrees, degrees) - scale_degrees.begin();
    const std::size_t d = above == 0 ? 0 : static_cast<std::size_t>(above) - 1;
    std::size_t likeliest = 0;
    for (std::size_t k = 1; k < sigma_count; ++k)
        if (over_grid[k * scale_degrees.size() + d] > over_grid[likeliest * scale_degrees.size() + d])
            likeliest = k;
    return sigma_at(likeliest);
}

}  // namespace

std::array<double, scatter_scales.size()> log_weights_of_scales(double degrees) {
    std::array<double, scatter_scales.size()> weights{};
    std::ranges::transform(scatter_scales, weights.begin(),
                           [&](double scale) { return -0.5 * degrees * (std::log(scale) + 1.0 / scale); });
    const double all = log_of_sum(weights);
    for (double& weight : weights) weight -= all;
    return weights;
}

WithinScatter::WithinScatter(std::span<const Stretches> units)
    : sum_(sigma_count * scale_degrees.size(), 0.0) {
    for (const Stretches& stretches : units) {
        of_unit_.emplace_back(sum_.size(), 0.0);
        contrasts_of_unit_.push_back(0.0);
        unnamed_of_unit_.push_back(0.0);
        unnamed_variance_of_unit_.push_back(0.0);
        for (const std::vector<Point>& stretch : stretches) add_to_last_unit(stretch);
        contrasts_ += contrasts_of_unit_.back();
        for (std::size_t k = 0; k < sum_.size(); ++k) sum_[k] += of_unit_.back()[k];
    }
}

void WithinScatter::add_to_last_unit(const std::vector<Point>& stretch) {
    double unnamed = 0.0;
    for (const Point& point : stretch)
        if (!point.named()) {
            unnamed += 1.0;
            unnamed_variance_of_unit_.back() += std::pow(as_normal(point).std, 2);
        }
    unnamed_of_unit_.back() += unnamed;
    const double named = static_cast<double>(stretch.size()) - unnamed;
    if (named == 0.0 || stretch.size() < 2) return;
    const std::vector<double> over_grid =
        unnamed > 0.0 ? log_likelihoods_with_limits(stretch) : log_likelihoods(stretch);
    for (std::size_t k = 0; k < over_grid.size(); ++k) of_unit_.back()[k] += over_grid[k];
    contrasts_of_unit_.back() += unnamed > 0.0 ? named : named - 1.0;
}

Scatter WithinScatter::best(const std::vector<double>& sum, double contrasts, const Scatter& common) {
    return contrasts < least_contrasts ? common
                                       : Scatter{likeliest_sigma(sum, common.degrees), common.degrees};
}

Scatter WithinScatter::of_all(const Scatter& common) const {
    return best(sum_, contrasts_, common);
}

Scatter WithinScatter::without(std::size_t unit, const Scatter& common) const {
    std::vector<double> sum = sum_;
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] -= of_unit_[unit][k];
    return best(sum, contrasts_ - contrasts_of_unit_[unit], common);
}

void WithinScatter::leave_out(std::size_t unit) {
    for (std::size_t k = 0; k < sum_.size(); ++k) sum_[k] -= of_unit_[unit][k];
    contrasts_ -= contrasts_of_unit_[unit];
    std::ranges::fill(of_unit_[unit], 0.0);
    contrasts_of_unit_[unit] = 0.0;
}

Scatter common_scatter(std::span<const WithinScatter> quantities,
                       std::span<const std::optional<std::size_t>> unit) {
    std::array<double, scale_degrees.size()> profile{};
    std::vector<double> sum(sigma_count * scale_degrees.size(), 0.0);
    double contrasts = 0.0, unnamed = 0.0, unnamed_variances = 0.0;
    for (std::size_t q = 0; q < quantities.size(); ++q) {
        const WithinScatter& quantity = quantities[q];
        for (std::size_t u = 0; u < quantity.unnamed_of_unit_.size(); ++u) {
            if (unit[q] == u) continue;
            unnamed += quantity.unnamed_of_unit_[u];
            unnamed_variances += quantity.unnamed_variance_of_unit_[u];
        }
        contrasts += quantity.contrasts_ - (unit[q] ? quantity.contrasts_of_unit_[*unit[q]] : 0.0);
        for (std::size_t d = 0; d < scale_degrees.size(); ++d) {
            double best = -std::numeric_limits<double>::infinity();
            for (std::size_t at = d; at < sum.size(); at += scale_degrees.size()) {
                const double of_others =
                    quantity.sum_[at] - (unit[q] ? quantity.of_unit_[*unit[q]][at] : 0.0);
                sum[at] += of_others;
                best = std::max(best, of_others);
            }
            profile[d] += best;
        }
    }
    if (contrasts < least_contrasts && unnamed >= least_contrasts)
        return {std::sqrt(unnamed_variances / unnamed), scale_degrees.back()};
    if (contrasts < 1.0) return {};
    const double degrees =
        scale_degrees[static_cast<std::size_t>(std::ranges::max_element(profile) - profile.begin())];
    return {likeliest_sigma(sum, degrees), std::min(contrasts, degrees)};
}

}  // namespace fidservo::fleet
