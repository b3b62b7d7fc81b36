// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/macro/macro_threshold.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace fidservo::calib {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double& threshold_V(MacroMotion& motion, double side) {
    return side > 0.0 ? motion.forward_threshold_V : motion.backward_threshold_V;
}

/// The distinct sizes of commands to one side, ascending; infinity, above which nothing drives, is the last.
std::vector<double> command_levels_V(const std::vector<MacroWindow>& windows, double side) {
    constexpr double distinct_V = 1e-9;
    std::vector<double> levels;
    for (const MacroWindow& window : windows)
        for (const double u : window.command_V)
            if (side * u > distinct_V) levels.push_back(side * u);
    std::sort(levels.begin(), levels.end());
    levels.erase(
        std::unique(levels.begin(), levels.end(), [](double a, double b) { return b - a < distinct_V; }),
        levels.end());
    return levels;
}

/// Smallest and largest command to one side over the ticks [from, to).
std::pair<double, double> push_V(const MacroWindow& window, double side, std::size_t from, std::size_t to) {
    double least_V = infinity, most_V = -infinity;
    for (std::size_t k = from; k < to; ++k) {
        least_V = std::min(least_V, side * window.command_V[k]);
        most_V = std::max(most_V, side * window.command_V[k]);
    }
    return {least_V, most_V};
}

std::size_t level_of(const std::vector<double>& levels, double size_V) {
    const auto found = std::lower_bound(levels.begin(), levels.end(), size_V);
    return std::min(static_cast<std::size_t>(found - levels.begin()), levels.size() - 1);
}

/// The level that lies `steps` from another, at most at the ends.
std::size_t stepped(const std::vector<double>& levels, std::size_t level, int steps) {
    const auto last = static_cast<std::ptrdiff_t>(levels.size()) - 1;
    return static_cast<std::size_t>(
        std::clamp<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(level) + steps, 0, last));
}

/// Moves one direction's threshold by some levels. Returns whether there was room to move.
bool move_threshold(MacroPoint& point, const std::vector<double>& levels, double side, int steps) {
    if (steps == 0 || levels.empty()) return false;
    double& value_V = threshold_V(point.motion, side);
    const std::size_t level = level_of(levels, value_V), next = stepped(levels, level, steps);
    value_V = levels[next];
    return next != level;
}

}  // namespace

bool ThresholdInterval::bounded() const {
    return std::isfinite(most_V);
}

double ThresholdInterval::std_V() const {
    return (most_V - above_V) / (2.0 * std::numbers::sqrt3);
}

ThresholdInterval threshold_from_rest(const std::vector<MacroWindow>& windows, double resolution_mm,
                                      double side) {
    constexpr double rested_s = 0.010, stays_s = 0.025, leaves_s = 0.060, leaves_count = 3.0;
    ThresholdInterval found{0.0, infinity};
    for (const MacroWindow& window : windows) {
        const auto ticks = [&](double time_s) {
            return std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(time_s / window.tick_s)));
        };
        const auto moved_count = [&](std::size_t from, std::size_t to) {
            return side * (window.position_mm[to] - window.position_mm[from]) / resolution_mm;
        };
        std::size_t rested = 0;  // since when the reading has not changed
        for (std::size_t k = 1; k + ticks(leaves_s) < window.position_mm.size(); ++k) {
            const bool changed = std::abs(moved_count(k - 1, k)) > 0.5;
            if (!changed && k - rested >= ticks(rested_s + stays_s))
                found.above_V = std::max(found.above_V, push_V(window, side, k - ticks(stays_s), k).first);
            const bool leaves = changed && k - rested >= ticks(rested_s) && moved_count(k - 1, k) > 0.0 &&
                                moved_count(k - 1, k + ticks(leaves_s)) > leaves_count;
            // Without a push it is the last count of a carriage that coasts.
            if (const double most_V = leaves ? push_V(window, side, k - ticks(rested_s), k).second : 0.0;
                most_V > 0.0)
                found.most_V = std::min(found.most_V, most_V);
            if (changed) rested = k;
        }
    }
    return found;
}

void search_thresholds(const MacroEstimator& estimator, MacroPoint& point, const MacroActive& active) {
    constexpr int iterations = 4;
    constexpr std::array<std::array<int, 2>, 8> directions{
        {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, -1}, {1, -1}, {-1, 1}}};
    const std::vector<double> forward = command_levels_V(estimator.windows(), +1.0);
    const std::vector<double> backward = command_levels_V(estimator.windows(), -1.0);
    double least = estimator.loss(point);
    for (int stride = 27; stride >= 1; stride /= 3) {
        for (bool better = true; better;) {
            better = false;
            for (const auto& direction : directions) {
                MacroPoint next = point;
                const bool moved_forward = move_threshold(next, forward, +1.0, stride * direction[0]);
                const bool moved_backward = move_threshold(next, backward, -1.0, stride * direction[1]);
                if (moved_forward != (direction[0] != 0) || moved_backward != (direction[1] != 0)) continue;
                if (const double loss = estimator.refine(next, active, iterations, least); loss < least) {
                    point = next;
                    least = loss;
                    better = true;
                }
            }
        }
    }
}

ThresholdInterval threshold_interval(const MacroEstimator& estimator, const MacroPoint& point,
                                     const MacroActive& active, double side, double allowance) {
    constexpr int iterations = 4;
    const std::vector<double> levels = command_levels_V(estimator.windows(), side);
    if (levels.empty()) return {0.0, infinity};
    const double most = estimator.loss(point) + allowance;
    const auto reach = [&](int step) {
        MacroPoint last = point;
        for (;;) {
            MacroPoint next = last;
            if (!move_threshold(next, levels, side, step)) break;
            if (!(estimator.refine(next, active, iterations, most) <= most)) break;
            last = next;
        }
        return level_of(levels, threshold_V(last.motion, side));
    };
    const std::size_t first = reach(-1), last = reach(+1);
    return {first > 0 ? levels[first - 1] : 0.0, levels[last]};
}

}  // namespace fidservo::calib
