// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/macro/macro_recordings.h"

#include "calib/significance.h"

#include <algorithm>
#include <cmath>

namespace fidservo::calib {

namespace {

/// Some of the windows with the model entering them as before.
struct Part {
    std::vector<MacroWindow> windows;
    std::vector<MacroMotionState> starts;
};

template <class Belongs>
Part part_of(const MacroEstimator& estimator, const MacroPoint& point, Belongs belongs) {
    Part part;
    for (std::size_t w = 0; w < estimator.windows().size(); ++w) {
        if (!belongs(w)) continue;
        part.windows.push_back(estimator.windows()[w]);
        part.starts.push_back(point.starts[w]);
    }
    return part;
}

bool drives_both_ways(const std::vector<MacroWindow>& windows) {
    bool forward = false, backward = false;
    for (const MacroWindow& window : windows)
        for (const double u : window.command_V) {
            forward = forward || u > 0.0;
            backward = backward || u < 0.0;
        }
    return forward && backward;
}

/// Of a sum of squares over `ticks` ticks, of which windows have taken up two a window with their starts.
double beyond_noise(double squares, double of_noise, double ticks, double windows) {
    constexpr double level_of_noise = 0.01;
    const double freedom = ticks - 2.0 * windows;
    if (freedom < 10.0 || of_noise <= 0.0) return 0.0;
    const double ratio = squares / freedom / (of_noise / ticks);
    const double bound =
        mean_square_ratio_bound(freedom, freedom / third_differences_correlated, level_of_noise);
    return ratio > bound ? 1.0 - bound / ratio : 0.0;
}

/// Square of a series' third difference at k, over that of white noise of unit variance.
template <class Series>
double white_square(const Series& y, std::size_t k) {
    constexpr double of_unit_noise = 20.0;
    const double third = y[k] - 3.0 * y[k - 1] + 3.0 * y[k - 2] - y[k - 3];
    return third * third / of_unit_noise;
}

/// Standard deviation of what is white from tick to tick, by third differences.
double white_noise_mm(const std::vector<MacroWindow>& windows) {
    double squares = 0.0, count = 0.0;
    for (const MacroWindow& window : windows)
        for (std::size_t k = 3; k < window.position_mm.size(); ++k) {
            squares += white_square(window.position_mm, k);
            ++count;
        }
    return count > 0.0 ? std::sqrt(squares / count) : 0.0;
}

std::size_t recordings_in(const MacroEstimator& estimator) {
    std::size_t count = 0;
    for (const MacroWindow& window : estimator.windows()) count = std::max(count, window.recording + 1);
    return count;
}

}  // namespace

std::array<MacroAgreement, macro_figure_count> macro_agreement(const MacroEstimator& estimator,
                                                               const MacroFit& fit, double unit_V,
                                                               double threshold_V) {
    std::array<MacroAgreement, macro_figure_count> agreement;
    const std::size_t recordings = recordings_in(estimator);
    for (std::size_t r = 0; r < recordings && recordings > 1; ++r) {
        const Part part = part_of(estimator, fit.point,
                                  [&](std::size_t w) { return estimator.windows()[w].recording == r; });
        if (part.windows.empty()) continue;
        const MacroEstimator own(part.windows, estimator.resolution_mm());
        MacroFit alone;
        alone.point = {fit.point.motion, part.starts, fit.point.noise_count};
        alone.active = fit.active;
        if (!drives_both_ways(part.windows)) alone.active[macro_index::offset] = false;
        refine_with_noise(own, alone.point, alone.active);
        alone.influences = own.influences(alone.point, alone.active);
        const MacroMotion& motion = alone.point.motion;
        const MacroFigures value = figures_of(motion, unit_V, threshold_V);
        const MacroFigureGradient gradient = figure_gradient(motion, unit_V, threshold_V);
        const MacroFigures most =
            largest_useful_std(value, own.fastest_mm_per_s(), mean_drive_V(part.windows, motion));
        for (int i = 0; i < macro_figure_count; ++i) {
            const BatchVariance variance = variance_along(alone.influences, gradient.row(i).transpose());
            const double std = std::sqrt(variance.variance);
            if (!std::isfinite(value[i]) || !(std > 0.0) || !(std <= most[i])) continue;
            MacroAgreement& of_figure = agreement[static_cast<std::size_t>(i)];
            of_figure.recordings.push_back(r);
            of_figure.own.push_back({value[i], std, variance.freedom});
        }
    }
    for (MacroAgreement& of_figure : agreement) of_figure.scatter = heterogeneity(of_figure.own);
    return agreement;
}

MacroMissed missed_share(const MacroEstimator& estimator, const MacroFit& fit, double drive_squares_count2) {
    constexpr double rounding = 1.0 / 12.0;
    double missed = 0.0, noise = 0.0, ticks = 0.0;
    for (std::size_t held_out = 0; held_out < 2; ++held_out) {
        const Part train = part_of(estimator, fit.point, [&](std::size_t w) { return w % 2 != held_out; });
        const Part test = part_of(estimator, fit.point, [&](std::size_t w) { return w % 2 == held_out; });
        if (train.windows.empty() || test.windows.empty()) return {};
        const MacroEstimator fitted(train.windows, estimator.resolution_mm());
        MacroPoint point{fit.point.motion, train.starts, fit.point.noise_count};
        refine_with_noise(fitted, point, fit.active);
        const MacroEstimator judged(test.windows, estimator.resolution_mm());
        MacroPoint other{point.motion, test.starts, point.noise_count};
        refine_with_noise(judged, other, {});
        for (std::size_t w = 0; w < test.windows.size(); ++w) {
            const std::vector<double> error = judged.errors_count(w, other);
            for (std::size_t k = 0; k < error.size(); ++k) {
                missed += error[k] * error[k];
                if (k >= 3) noise += white_square(error, k);
            }
            ticks += static_cast<double>(error.size());
        }
    }
    const double of_noise = std::max(noise, rounding * ticks);
    MacroMissed result{std::nullopt, std::sqrt(of_noise / ticks)};
    result.beyond_noise =
        beyond_noise(missed, of_noise, ticks, static_cast<double>(estimator.windows().size()));
    if (drive_squares_count2 > of_noise)
        result.share = std::sqrt(std::max(0.0, missed - of_noise) / drive_squares_count2);
    return result;
}

MacroManoeuvres manoeuvres(const MacroEstimator& estimator, const MacroMotion& motion) {
    constexpr double least_way_count = 4.0, least_way_noise = 6.0, least_speed_share = 0.1, span_s = 0.02;
    MacroManoeuvres found;
    const double least_mm = std::max(least_way_count * estimator.resolution_mm(),
                                     least_way_noise * white_noise_mm(estimator.windows()));
    double side = 0.0, turn_mm = 0.0;
    std::size_t recording = SIZE_MAX;
    for (const MacroWindow& window : estimator.windows()) {
        if (window.recording != recording) {
            side = 0.0;
            turn_mm = window.position_mm[0];
            recording = window.recording;
        }
        const auto span = std::max<std::size_t>(1, static_cast<std::size_t>(span_s / window.tick_s));
        for (std::size_t k = 0; k < window.position_mm.size(); ++k) {
            const double y_mm = window.position_mm[k];
            if (side * (y_mm - turn_mm) > 0.0) turn_mm = y_mm;
            if (const double way_mm = y_mm - turn_mm; std::abs(way_mm) > least_mm && way_mm * side <= 0.0) {
                found.reversals += side != 0.0 ? 1 : 0;
                side = std::copysign(1.0, way_mm);
                turn_mm = y_mm;
            }
            if (k < span || drive_speed_mm_per_s(motion, window.command_V[k]) != 0.0) continue;
            const double speed =
                std::abs(y_mm - window.position_mm[k - span]) / (static_cast<double>(span) * window.tick_s);
            if (speed > least_speed_share * estimator.fastest_mm_per_s()) found.coasted_s += window.tick_s;
        }
    }
    return found;
}

}  // namespace fidservo::calib
