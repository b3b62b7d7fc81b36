// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/import/clock_fit.h"

#include "src/import/lag_scan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>
#include <fmt/format.h>

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

/// The fit's unknowns: shift in the middle of the track, rate, scale and offset of the values.
struct Alignment {
    double middle_s = 0.0;
    Eigen::Vector4d unknowns = Eigen::Vector4d::Zero();
    Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
    double correlation = 0.0;
    double independent = 0.0;  ///< samples, after what neighbours share
    /// What the slopes tell of the rate, in standard deviations of what noise would tell.
    double rate_in_stds = 0.0;
    double spread_s = 0.0;  ///< standard deviation of the times of motion
};

double slope_at(const MotionTrack& track, double at, double half_step_s) {
    return (value_at(track, at + half_step_s) - value_at(track, at - half_step_s)) / (2.0 * half_step_s);
}

/// What slopes tell of the rate beside the shift: R = sum s (t - t0)^2 with s the product of the slopes in
/// both signals and t0 their mean time. Of noise, which is independent in the two, R scatters about 0.
class RateShown {
  public:
    void add(double slopes, double from_middle) {
        double power = 1.0;
        for (std::size_t k = 0; k < powers_.size(); ++k, power *= from_middle) {
            if (k < sums_.size()) sums_[k] += slopes * power;
            powers_[k] += power;
        }
    }
    /// R over its standard deviation where s is noise of a standard deviation.
    double in_stds(double slopes_std) const {
        if (!moves()) return 0.0;
        const double t0 = mean_time_s();
        const auto& p = powers_;
        const double fourth = p[4] - 4.0 * t0 * p[3] + 6.0 * t0 * t0 * p[2] - 4.0 * std::pow(t0, 3) * p[1] +
                              std::pow(t0, 4) * p[0];
        return about_mean_time() / (slopes_std * std::sqrt(fourth));
    }

    /// Standard deviation of the times at which the signals move, s.
    double spread_s() const { return moves() ? std::sqrt(std::max(0.0, about_mean_time() / sums_[0])) : 0.0; }

  private:
    bool moves() const { return sums_[0] > 0.0; }
    double mean_time_s() const { return sums_[1] / sums_[0]; }
    double about_mean_time() const { return sums_[2] - mean_time_s() * sums_[1]; }  ///< R

    std::array<double, 3> sums_{};    ///< of s t^k
    std::array<double, 5> powers_{};  ///< of t^k
};

/// Of the residuals r = x(s(t)) - a y(t) - b with their derivatives g, the equations sum h g' move = sum h r.
/// The instruments h have the track's slopes where g has the reference's: noise, which is independent in the
/// two, would make slopes steeper than they are, and the clock better known (instrumental variables; Fuller,
/// Measurement Error Models, 1987, 1.4). Their covariance counts each residual where it is, since the tracks
/// differ most where they move (White, Econometrica 48, 1980).
struct Equations {
    Eigen::Matrix4d cross = Eigen::Matrix4d::Zero();    ///< sum h g'
    Eigen::Matrix4d scatter = Eigen::Matrix4d::Zero();  ///< sum h h' r^2
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    std::vector<double> residuals;
    double reference_energy = 0.0;
    RateShown rate_shown;
};

/// @param track_slopes  of the track at its samples, by the same differences
Equations equations_at(const Alignment& now, const MotionTrack& track,
                       const std::vector<double>& track_slopes, const MotionTrack& reference,
                       double half_step_s) {
    Equations all;
    const double low = reference.time_s.front() + half_step_s, high = reference.time_s.back() - half_step_s;
    double sum = 0.0, squares = 0.0;
    for (std::size_t k = 0; k < track.time_s.size(); ++k) {
        const double from_middle = track.time_s[k] - now.middle_s;
        const double at = track.time_s[k] + now.unknowns[0] + now.unknowns[1] * from_middle;
        if (at < low || at > high) continue;
        const double x = value_at(reference, at);
        const double slope = slope_at(reference, at, half_step_s);
        const double own_slope = track_slopes[k];
        const Eigen::Vector4d gradient(slope, slope * from_middle, -track.value[k], -1.0);
        const Eigen::Vector4d instrument(own_slope, own_slope * from_middle, -track.value[k], -1.0);
        const double residual = x - now.unknowns[2] * track.value[k] - now.unknowns[3];
        all.cross += instrument * gradient.transpose();
        all.scatter += residual * residual * instrument * instrument.transpose();
        all.right -= instrument * residual;
        all.residuals.push_back(residual);
        all.rate_shown.add(std::copysign(1.0, now.unknowns[2]) * own_slope * slope, from_middle);
        sum += x;
        squares += x * x;
    }
    all.reference_energy =
        squares - sum * sum / std::max<double>(1.0, static_cast<double>(all.residuals.size()));
    return all;
}

void judge(Alignment& alignment, const Equations& at_end, double half_step_s) {
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
    const Eigen::Matrix4d inverse = at_end.cross.fullPivLu().inverse();
    alignment.covariance = inflation * inverse * at_end.scatter * inverse.transpose();
    const double explained = std::max(0.0, 1.0 - square / std::max(at_end.reference_energy, 1e-300));
    alignment.correlation = std::copysign(std::sqrt(explained), alignment.unknowns[2]);
    // Of white noise in x and a y, whose variances have the product var(r)^2 / 4 at most.
    const double most_product = 0.5 * square / std::max(1.0, count - 4.0) / std::abs(alignment.unknowns[2]);
    alignment.spread_s = at_end.rate_shown.spread_s();
    alignment.rate_in_stds = at_end.rate_shown.in_stds(most_product / (2.0 * half_step_s * half_step_s));
}

enum class Rate { fitted, held };

/// @param begin        the shift in the middle of the track and the rate at first
/// @param half_step_s  half width of the differences from which slopes are computed
Alignment align(const MotionTrack& track, const MotionTrack& reference, const Eigen::Vector2d& begin,
                double half_step_s, Rate rate = Rate::fitted) {
    constexpr double fastest = 0.1;
    Alignment now;
    now.middle_s = 0.5 * (track.time_s.front() + track.time_s.back());
    now.unknowns.head<2>() = begin;
    std::vector<double> track_slopes;
    track_slopes.reserve(track.time_s.size());
    for (const double time_s : track.time_s) track_slopes.push_back(slope_at(track, time_s, half_step_s));
    const auto equations_here = [&] {
        return equations_at(now, track, track_slopes, reference, half_step_s);
    };
    constexpr int most_rounds = 50;
    for (int round = 0; round < most_rounds; ++round) {
        const Equations equations = equations_here();
        if (equations.residuals.size() < fewest_samples) break;
        // Scale and offset follow from the first round on; the shift moves by a step at most.
        Eigen::Vector4d move = equations.cross.fullPivLu().solve(equations.right);
        if (round == 0) move.head<2>().setZero();
        if (rate == Rate::held) move[1] = 0.0;
        move[0] = std::clamp(move[0], -half_step_s, half_step_s);
        now.unknowns += move;
        now.unknowns[1] = std::clamp(now.unknowns[1], -fastest, fastest);
        if (round > 1 && std::abs(move[0]) < 1e-6 * half_step_s) break;
    }
    judge(now, equations_here(), half_step_s);
    return now;
}

/// Standard deviation of the shift, s, at a time of the track.
double shift_std_s(const Alignment& alignment, double time_s) {
    const double from_middle = time_s - alignment.middle_s;
    const Eigen::Matrix4d& covariance = alignment.covariance;
    return std::sqrt(std::max(0.0, covariance(0, 0) + 2.0 * from_middle * covariance(0, 1) +
                                       from_middle * from_middle * covariance(1, 1)));
}

bool shows_rate(const Alignment& alignment) {
    constexpr double is_shown = 4.0;
    return alignment.rate_in_stds >= is_shown;
}

/// The alignment by those differences that make the shift best known, from one step to half of the lag over
/// which the motion changes. Where none shows the rate, that by one step with the rate held at 0.
Alignment align_by_best_slopes(const MotionTrack& track, const MotionTrack& reference, double shift_s,
                               double step_s, double change_s) {
    const auto std_s = [](const Alignment& alignment) { return shift_std_s(alignment, alignment.middle_s); };
    std::optional<Alignment> narrowest, best;
    for (double half_step_s = step_s; half_step_s <= std::max(step_s, 0.5 * change_s); half_step_s *= 4.0) {
        const Alignment held = align(track, reference, {shift_s, 0.0}, half_step_s, Rate::held);
        if (!narrowest) narrowest = held;
        if (!shows_rate(held)) continue;
        const Alignment fitted = align(track, reference, held.unknowns.head<2>(), half_step_s);
        if (!shows_rate(fitted)) continue;
        if (!best || std_s(fitted) < std_s(*best)) best = fitted;
    }
    return best ? *best : *narrowest;
}

/// The share of the reference's energy that a fit leaves; never less than what lines between samples do.
double left_by(const Alignment& alignment) {
    constexpr double of_lines = 1e-6;
    return std::max(of_lines, 1.0 - alignment.correlation * alignment.correlation);
}

/// Fisher's z = artanh |r|, whose standard deviation is 1 / sqrt(n - 3) with n independent samples.
struct FisherZ {
    double z = 0.0, variance = 0.0;
};

FisherZ fisher_z(const Alignment& alignment) {
    return {std::atanh(std::sqrt(1.0 - left_by(alignment))),
            1.0 / (std::max(4.0, alignment.independent) - 3.0)};
}

/// @param lags  looked at
std::string why_no_common_motion(const Alignment& alignment, std::size_t lags) {
    const auto [z, variance] = fisher_z(alignment);
    // Of one look, at the level of all looks together: exp(-z^2 / 2) < level / lags.
    if (0.5 * z * z / variance >= std::log(static_cast<double>(lags) / chance_of_error)) return {};
    return fmt::format("the two see no common motion: their largest correlation is {:.2f}",
                       alignment.correlation);
}

/// Were the other as right, its correlation would scatter as that of the first.
std::string why_ambiguous(const Alignment& alignment, const Alignment& other) {
    constexpr double one_in_a_hundred = 2.326;  // of a normal distribution, to one side
    const auto [z, variance] = fisher_z(alignment);
    if (z - fisher_z(other).z > one_in_a_hundred * std::sqrt(2.0 * variance)) return {};
    return fmt::format(
        "the motion repeats: correlation {:.4f}, and {:.4f} with an offset that differs by {:+.3g} s; give "
        "offset_s",
        std::abs(alignment.correlation), std::abs(other.correlation),
        other.unknowns[0] - alignment.unknowns[0]);
}

/// @param change_s  lags over which the correlation halves: beyond them, slopes say nothing
std::string why_undetermined(const Alignment& alignment, const MotionTrack& track, double change_s) {
    const double worst_s =
        std::max(shift_std_s(alignment, track.time_s.front()), shift_std_s(alignment, track.time_s.back()));
    constexpr double furthest = 10.0;  // of the motion's spread, that the rate is extrapolated
    const double half_length_s = 0.5 * (track.time_s.back() - track.time_s.front());
    if (!shows_rate(alignment) || half_length_s > furthest * alignment.spread_s)
        return "the motion does not determine the clock's rate: it is too short, or drowns in noise; give "
               "offset_s";
    if (worst_s < change_s) return {};
    return fmt::format(
        "the motion does not determine the clock: the offset's standard deviation is {:.3g} s, which is not "
        "below the {:.3g} s over which the correlation halves; give offset_s",
        worst_s, change_s);
}

/// The highest maxima but the first, of those that stand out from the scatter of a correlation of as many
/// samples as a lag has in common.
std::vector<LagPeak> rivals(const LagScan& scan, const std::vector<LagPeak>& peaks) {
    constexpr std::size_t most_rivals = 4;
    constexpr double stands_out = 3.0;  // standard errors
    const double scatter = 1.0 / std::sqrt(static_cast<double>(scan.common));
    std::vector<LagPeak> chosen;
    for (std::size_t k = 1; k < peaks.size() && chosen.size() < most_rivals; ++k) {
        const double r = scan.correlation[peaks[k].at];
        if (peaks[k].prominence > stands_out * (1.0 - r * r) * scatter) chosen.push_back(peaks[k]);
    }
    return chosen;
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
    const std::vector<LagPeak> peaks = peaks_of(scan);
    const double slope_step_s = std::max(median_step(track.time_s), median_step(reference.time_s));
    const auto shift_at = [&](const LagPeak& peak) {
        const double lag_s = static_cast<double>(scan.first + static_cast<std::ptrdiff_t>(peak.at)) * step_s;
        return reference.time_s.front() + lag_s - track.time_s.front();
    };
    const double change_s = 0.5 * static_cast<double>(width_at_half_height(scan, peaks.front().at)) * step_s;
    const Alignment alignment =
        align_by_best_slopes(track, reference, shift_at(peaks.front()), slope_step_s, change_s);
    if (const std::string why = why_no_common_motion(alignment, scan.correlation.size()); !why.empty())
        return tl::make_unexpected(why);
    for (const LagPeak& rival : rivals(scan, peaks)) {
        const Alignment other =
            align(track, reference, {shift_at(rival), alignment.unknowns[1]}, slope_step_s, Rate::held);
        if (std::abs(other.unknowns[0] - alignment.unknowns[0]) < slope_step_s) continue;
        if (const std::string why = why_ambiguous(alignment, other); !why.empty())
            return tl::make_unexpected(why);
    }
    if (const std::string why = why_undetermined(alignment, track, change_s); !why.empty())
        return tl::make_unexpected(why);
    return ClockFit{.offset_s = alignment.unknowns[0] +
                                (track.time_s.front() - alignment.middle_s) * alignment.unknowns[1],
                    .offset_std_s = shift_std_s(alignment, track.time_s.front()),
                    .rate_ppm = 1e6 * alignment.unknowns[1],
                    .rate_std_ppm = 1e6 * std::sqrt(std::max(0.0, alignment.covariance(1, 1))),
                    .correlation = alignment.correlation};
}

}  // namespace fidservo::imports
