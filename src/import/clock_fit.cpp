// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/import/clock_fit.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <fmt/format.h>
#include <opencv2/core.hpp>

namespace fidservo::imports {
namespace {

constexpr std::size_t fewest_samples = 20;
constexpr std::size_t most_grid = std::size_t{1} << 20U;
constexpr double chance_of_error = 0.01;

double median_step(const std::vector<double>& time_s) {
    std::vector<double> steps(time_s.size() - 1);
    for (std::size_t k = 0; k < steps.size(); ++k) steps[k] = time_s[k + 1] - time_s[k];
    std::ranges::nth_element(steps, steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2));
    return steps[steps.size() / 2];
}

/// Straight lines between samples; `at` inside the track.
double value_at(const MotionTrack& track, double at) {
    const auto after = std::ranges::upper_bound(track.time_s, at);
    const auto k = std::clamp<std::ptrdiff_t>(after - track.time_s.begin() - 1, 0,
                                              static_cast<std::ptrdiff_t>(track.time_s.size()) - 2);
    const auto i = static_cast<std::size_t>(k);
    const double share = (at - track.time_s[i]) / (track.time_s[i + 1] - track.time_s[i]);
    return track.value[i] + share * (track.value[i + 1] - track.value[i]);
}

/// On a grid from the track's first time on, without its mean.
std::vector<double> on_grid(const MotionTrack& track, double step_s) {
    const double span = track.time_s.back() - track.time_s.front();
    std::vector<double> values(static_cast<std::size_t>(span / step_s) + 1);
    for (std::size_t k = 0; k < values.size(); ++k)
        values[k] = value_at(track, track.time_s.front() + static_cast<double>(k) * step_s);
    const double mean = std::reduce(values.begin(), values.end()) / static_cast<double>(values.size());
    for (double& value : values) value -= mean;
    return values;
}

/// sums[k]: of the first k values and of their squares.
struct RunningSums {
    explicit RunningSums(const std::vector<double>& values) : sum(1, 0.0), square(1, 0.0) {
        for (const double value : values) {
            sum.push_back(sum.back() + value);
            square.push_back(square.back() + value * value);
        }
    }
    std::vector<double> sum, square;
};

/// Of y[i] with x[i + lag], summed, for every lag: element (lag + size) % size.
std::vector<double> products_by_lag(const std::vector<double>& y, const std::vector<double>& x) {
    const int size = cv::getOptimalDFTSize(static_cast<int>(x.size() + y.size()));
    const auto spectrum = [&](const std::vector<double>& values) {
        cv::Mat padded = cv::Mat::zeros(1, size, CV_64F), out;
        std::ranges::copy(values, padded.ptr<double>());
        cv::dft(padded, out);
        return out;
    };
    cv::Mat product, back;
    cv::mulSpectrums(spectrum(x), spectrum(y), product, 0, true);
    cv::dft(product, back, cv::DFT_INVERSE | cv::DFT_SCALE | cv::DFT_REAL_OUTPUT);
    return {back.ptr<double>(), back.ptr<double>() + size};
}

/// Pearson's correlation at each lag that leaves enough in common; 0 where one of the two does not move.
struct LagScan {
    std::ptrdiff_t first = 0;  ///< lag of correlation[0]
    std::vector<double> correlation;
};

LagScan scan_lags(const std::vector<double>& y, const std::vector<double>& x) {
    const auto nx = static_cast<std::ptrdiff_t>(x.size()), ny = static_cast<std::ptrdiff_t>(y.size());
    const std::ptrdiff_t least = std::min(nx, ny) / 2;
    const std::vector<double> products = products_by_lag(y, x);
    const RunningSums of_x(x), of_y(y);
    LagScan scan{least - ny, {}};
    for (std::ptrdiff_t lag = scan.first; lag <= nx - least; ++lag) {
        const auto x0 = static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, lag));
        const auto x1 = static_cast<std::size_t>(std::min(nx, lag + ny));
        const auto y0 = static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, -lag)), y1 = y0 + (x1 - x0);
        const double n = static_cast<double>(x1 - x0);
        const double sx = of_x.sum[x1] - of_x.sum[x0], sy = of_y.sum[y1] - of_y.sum[y0];
        const double xx = of_x.square[x1] - of_x.square[x0] - sx * sx / n;
        const double yy = of_y.square[y1] - of_y.square[y0] - sy * sy / n;
        const auto at = static_cast<std::size_t>(lag < 0 ? lag + std::ssize(products) : lag);
        constexpr double moves = 1e-9;  // of the whole signal's energy
        const bool both_move = xx > moves * of_x.square.back() && yy > moves * of_y.square.back();
        scan.correlation.push_back(both_move ? (products[at] - sx * sy / n) / std::sqrt(xx * yy) : 0.0);
    }
    return scan;
}

/// Where |r| is largest, and where it is largest outside of the hill that the first stands on.
struct Peaks {
    std::size_t best = 0;
    std::optional<std::size_t> second;
};

Peaks peaks_of(const std::vector<double>& correlation) {
    const auto size_at = [&](std::size_t k) { return std::abs(correlation[k]); };
    Peaks peaks;
    for (std::size_t k = 1; k < correlation.size(); ++k)
        if (size_at(k) > size_at(peaks.best)) peaks.best = k;
    const double foot = 0.5 * size_at(peaks.best);
    std::size_t low = peaks.best, high = peaks.best;
    while (low > 0 && size_at(low - 1) > foot) --low;
    while (high + 1 < correlation.size() && size_at(high + 1) > foot) ++high;
    for (std::size_t k = 0; k < correlation.size(); ++k)
        if ((k < low || k > high) && (!peaks.second || size_at(k) > size_at(*peaks.second))) peaks.second = k;
    return peaks;
}

/// The fit's unknowns: shift in the middle of the track, rate, scale and offset of the values.
struct Alignment {
    double middle_s = 0.0;
    Eigen::Vector4d unknowns = Eigen::Vector4d::Zero();
    Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
    double correlation = 0.0;
    double independent = 0.0;  ///< samples, after what neighbours share
};

struct Equations {
    Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    std::vector<double> residuals;
    double reference_energy = 0.0;
};

Equations equations_at(const Alignment& now, const MotionTrack& track, const MotionTrack& reference,
                       double half_step_s) {
    Equations all;
    const double low = reference.time_s.front() + half_step_s, high = reference.time_s.back() - half_step_s;
    double sum = 0.0, squares = 0.0;
    for (std::size_t k = 0; k < track.time_s.size(); ++k) {
        const double from_middle = track.time_s[k] - now.middle_s;
        const double at = track.time_s[k] + now.unknowns[0] + now.unknowns[1] * from_middle;
        if (at < low || at > high) continue;
        const double x = value_at(reference, at);
        const double slope = (value_at(reference, at + half_step_s) - value_at(reference, at - half_step_s)) /
                             (2.0 * half_step_s);
        const Eigen::Vector4d gradient(slope, slope * from_middle, -track.value[k], -1.0);
        const double residual = x - now.unknowns[2] * track.value[k] - now.unknowns[3];
        all.normal += gradient * gradient.transpose();
        all.right -= gradient * residual;
        all.residuals.push_back(residual);
        sum += x;
        squares += x * x;
    }
    all.reference_energy =
        squares - sum * sum / std::max<double>(1.0, static_cast<double>(all.residuals.size()));
    return all;
}

void judge(Alignment& alignment, const Equations& at_end) {
    double square = 0.0, neighbours = 0.0;
    for (std::size_t k = 0; k < at_end.residuals.size(); ++k) {
        square += at_end.residuals[k] * at_end.residuals[k];
        if (k > 0) neighbours += at_end.residuals[k] * at_end.residuals[k - 1];
    }
    constexpr double most_rho = 0.999;
    const double rho = square > 0.0 ? std::clamp(neighbours / square, 0.0, most_rho) : 0.0;
    const double inflation = (1.0 + rho) / (1.0 - rho);
    const double count = static_cast<double>(at_end.residuals.size());
    alignment.independent = count / inflation;
    const double variance = square / std::max(1.0, count - 4.0) * inflation;
    alignment.covariance = variance * at_end.normal.ldlt().solve(Eigen::Matrix4d::Identity());
    const double explained = std::max(0.0, 1.0 - square / std::max(at_end.reference_energy, 1e-300));
    alignment.correlation = std::copysign(std::sqrt(explained), alignment.unknowns[2]);
}

Alignment align(const MotionTrack& track, const MotionTrack& reference, double shift_s, double step_s) {
    Alignment now;
    now.middle_s = 0.5 * (track.time_s.front() + track.time_s.back());
    now.unknowns[0] = shift_s;
    constexpr int most_rounds = 50;
    for (int round = 0; round < most_rounds; ++round) {
        const Equations equations = equations_at(now, track, reference, step_s);
        if (equations.residuals.size() < fewest_samples) break;
        // Scale and offset follow from the first round on; the shift moves by a step at most.
        Eigen::Vector4d move = equations.normal.ldlt().solve(equations.right);
        if (round == 0) move.head<2>().setZero();
        move[0] = std::clamp(move[0], -step_s, step_s);
        now.unknowns += move;
        if (round > 1 && std::abs(move[0]) < 1e-6 * step_s) break;
    }
    judge(now, equations_at(now, track, reference, step_s));
    return now;
}

/// The share of the reference's energy that a fit leaves; never less than what lines between samples do.
double left_by(const Alignment& alignment) {
    constexpr double of_lines = 1e-6;
    return std::max(of_lines, 1.0 - alignment.correlation * alignment.correlation);
}

std::string why_no_common_motion(const Alignment& alignment, const std::optional<Alignment>& other,
                                 std::size_t lags) {
    const double n = std::max(4.0, alignment.independent);
    // Fisher's z of one look, at the level of all looks together: exp(-z^2 / 2) < level / lags.
    const double z = std::atanh(std::sqrt(1.0 - left_by(alignment))) * std::sqrt(n - 3.0);
    if (0.5 * z * z < std::log(static_cast<double>(lags) / chance_of_error))
        return fmt::format("the two see no common motion: their largest correlation is {:.2f}",
                           alignment.correlation);
    if (other && 0.5 * n * std::log(left_by(*other) / left_by(alignment)) < std::log(1.0 / chance_of_error))
        return fmt::format(
            "the motion repeats: correlation {:.4f}, and {:.4f} with another offset; give offset_s",
            std::abs(alignment.correlation), std::abs(other->correlation));
    return {};
}

bool is_at_rest(const MotionTrack& track) {
    const auto [low, high] = std::ranges::minmax(track.value);
    return low == high;
}

}  // namespace

tl::expected<ClockFit, std::string> fit_clock(const MotionTrack& track, const MotionTrack& reference) {
    if (track.value.size() < fewest_samples || reference.value.size() < fewest_samples)
        return tl::make_unexpected(fmt::format("fewer than {} samples", fewest_samples));
    if (is_at_rest(track) || is_at_rest(reference))
        return tl::make_unexpected(std::string("one of the two does not move"));
    const double longest = std::max(track.time_s.back() - track.time_s.front(),
                                    reference.time_s.back() - reference.time_s.front());
    const double step_s = std::max({std::min(median_step(track.time_s), median_step(reference.time_s)),
                                    longest / static_cast<double>(most_grid)});
    const std::vector<double> y = on_grid(track, step_s), x = on_grid(reference, step_s);
    if (y.size() < fewest_samples || x.size() < fewest_samples)
        return tl::make_unexpected(std::string("one of the two is too short"));
    const LagScan scan = scan_lags(y, x);
    const Peaks peaks = peaks_of(scan.correlation);
    const double slope_step_s = std::max(median_step(track.time_s), median_step(reference.time_s));
    const auto align_at = [&](std::size_t peak) {
        const double lag_s = static_cast<double>(scan.first + static_cast<std::ptrdiff_t>(peak)) * step_s;
        return align(track, reference, reference.time_s.front() + lag_s - track.time_s.front(), slope_step_s);
    };
    const Alignment alignment = align_at(peaks.best);
    const auto other = peaks.second ? std::optional(align_at(*peaks.second)) : std::nullopt;
    if (const std::string why = why_no_common_motion(alignment, other, scan.correlation.size()); !why.empty())
        return tl::make_unexpected(why);
    const double back_s = track.time_s.front() - alignment.middle_s;
    const Eigen::Matrix4d& covariance = alignment.covariance;
    const double offset_variance =
        covariance(0, 0) + 2.0 * back_s * covariance(0, 1) + back_s * back_s * covariance(1, 1);
    return ClockFit{.offset_s = alignment.unknowns[0] + back_s * alignment.unknowns[1],
                    .offset_std_s = std::sqrt(std::max(0.0, offset_variance)),
                    .rate_ppm = 1e6 * alignment.unknowns[1],
                    .rate_std_ppm = 1e6 * std::sqrt(std::max(0.0, covariance(1, 1))),
                    .correlation = alignment.correlation};
}

}  // namespace fidservo::imports
