#include "src/fleet/report/statistics/within_scatter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace fidservo::fleet {
namespace {

/// Degrees of freedom that are looked at. The last is as good as a scale that all units share.
constexpr std::array scale_degrees{2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0, 24.0, 32.0, 64.0, 128.0, 1e5};
constexpr std::size_t sigma_count = 45;

/// 0, and from 0.02 floors on in steps of a fifth up to 44.
double sigma_at(std::size_t k) {
    constexpr double first = 0.02, ratio = 1.2;
    return k == 0 ? 0.0 : first * std::pow(ratio, static_cast<double>(k - 1));
}

std::vector<double> log_likelihoods(const std::vector<Point>& points) {
    std::vector<double> over_grid(sigma_count * scale_degrees.size(), 0.0);
    const double contrasts = static_cast<double>(points.size()) - 1.0;
    if (contrasts < 1.0) return over_grid;
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

}  // namespace

WithinScatter::WithinScatter(std::span<const std::vector<Point>> units)
    : sum_(sigma_count * scale_degrees.size(), 0.0) {
    for (const std::vector<Point>& points : units) {
        std::vector<Point> named;
        std::ranges::copy_if(points, std::back_inserter(named),
                             [](const Point& point) { return point.named && point.std > 0.0; });
        of_unit_.push_back(log_likelihoods(named));
        contrasts_of_unit_.push_back(named.size() > 1 ? static_cast<double>(named.size()) - 1.0 : 0.0);
        contrasts_ += contrasts_of_unit_.back();
        for (std::size_t k = 0; k < sum_.size(); ++k) sum_[k] += of_unit_.back()[k];
    }
}

Scatter WithinScatter::best(const std::vector<double>& sum, double contrasts) const {
    if (contrasts < 1.0) return {};
    const auto at = static_cast<std::size_t>(std::ranges::max_element(sum) - sum.begin());
    return {sigma_at(at / scale_degrees.size()),
            std::min(contrasts, scale_degrees[at % scale_degrees.size()])};
}

Scatter WithinScatter::of_all() const {
    return best(sum_, contrasts_);
}

Scatter WithinScatter::without(std::size_t unit) const {
    std::vector<double> sum = sum_;
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] -= of_unit_[unit][k];
    return best(sum, contrasts_ - contrasts_of_unit_[unit]);
}

void WithinScatter::leave_out(std::size_t unit) {
    for (std::size_t k = 0; k < sum_.size(); ++k) sum_[k] -= of_unit_[unit][k];
    contrasts_ -= contrasts_of_unit_[unit];
    std::ranges::fill(of_unit_[unit], 0.0);
    contrasts_of_unit_[unit] = 0.0;
}

}  // namespace fidservo::fleet
