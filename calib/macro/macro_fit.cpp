// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/macro/macro_fit.h"

#include "calib/macro/macro_recordings.h"
#include "calib/macro/macro_rivals.h"
#include "calib/tails.h"
#include "core/failure.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace fidservo::calib {

namespace {

constexpr double least_piece_s = 0.06;

/// Whether the carriage was driven to both sides for 20 ms in all.
bool drives_both_ways(const std::vector<MacroWindow>& windows, const MacroMotion& motion) {
    constexpr double least_s = 0.02;
    double forward_s = 0.0, backward_s = 0.0;
    for (const MacroWindow& window : windows) {
        for (const double u : window.command_V) {
            if (u > 0.0 && u >= motion.forward_threshold_V) forward_s += window.tick_s;
            if (u < 0.0 && -u >= motion.backward_threshold_V) backward_s += window.tick_s;
        }
    }
    return forward_s >= least_s && backward_s >= least_s;
}

/// A threshold at a share of an interval; its lower end where nothing is seen to start. Above 0 V, which
/// never drives a rig with a dead zone.
double within(const ThresholdInterval& interval, double share) {
    constexpr double least_V = 1e-6;
    const double width_V = interval.bounded() ? interval.most_V - interval.above_V : 0.0;
    return std::max(least_V, interval.above_V + share * width_V);
}

/// A first model: thresholds by what the carriage did from rest, and the best of several time constants; a
/// time constant of 0 if none follows the recordings.
MacroPoint first_point(const MacroEstimator& estimator, const MacroBuild& build, MacroFit& fit) {
    constexpr int iterations = 8;
    MacroMotion motion;
    if (build.dead_zone) {
        fit.forward = threshold_from_rest(estimator.windows(), build.resolution_mm, +1.0);
        fit.backward = threshold_from_rest(estimator.windows(), build.resolution_mm, -1.0);
        if (!fit.forward.bounded()) fit.forward = fit.backward;
        if (!fit.backward.bounded()) fit.backward = fit.forward;
        motion.forward_threshold_V = within(fit.forward, 0.5);
        motion.backward_threshold_V = within(fit.backward, 0.5);
    }
    const double drive_V = mean_drive_V(estimator.windows(), motion);
    const double speed_mm_per_s = 0.5 * estimator.fastest_mm_per_s();
    motion.centre_V = build.dead_zone ? drive_V : 0.0;
    motion.speed_mm_per_s = build.dead_zone ? speed_mm_per_s : 0.0;
    motion.slope_mm_per_s_per_V = speed_mm_per_s / drive_V;

    MacroPoint best;
    double least = std::numeric_limits<double>::infinity();
    for (const double tau_s : {0.005, 0.02, 0.08, 0.3, 1.2}) {
        motion.time_constant_s = tau_s;
        MacroPoint point = estimator.start_at(motion);
        point.noise_count = 10.0 + estimator.fastest_mm_per_s() * 0.02 / build.resolution_mm;
        if (const double loss = estimator.refine(point, fit.active, iterations); loss < least)
            best = point, least = loss;
    }
    return best;
}

/// Both thresholds at the same share of their first intervals, on ever finer grids, with everything else but
/// friction and offset refitted: speeds and thresholds make up for each other, so that neither can be found
/// with the other held.
void scan_thresholds(const MacroEstimator& estimator, MacroFit& fit) {
    constexpr int zooms = 3, grid = 6, iterations = 6;
    MacroActive active = fit.active;
    active[macro_index::friction] = active[macro_index::offset] = false;
    MacroPoint start = fit.point;
    start.motion.friction_mm_per_s = start.motion.offset_V = 0.0;
    double least = std::numeric_limits<double>::infinity(), best_share = 0.5, reach = 0.5;
    for (int zoom = 0; zoom < zooms; ++zoom, reach *= 2.0 / grid) {
        start.noise_count = std::max(1.0, estimator.noise_count(start));
        least = std::numeric_limits<double>::infinity();
        const double centre = best_share;
        for (int i = 0; i <= grid; ++i) {
            const double share = centre + reach * (2.0 * i / grid - 1.0);
            MacroPoint point = start;
            point.motion.forward_threshold_V = within(fit.forward, share);
            point.motion.backward_threshold_V = within(fit.backward, share);
            if (const double loss = estimator.refine(point, active, iterations); loss < least) {
                fit.point = point;
                least = loss;
                best_share = share;
            }
        }
        start = fit.point;
    }
}

/// Parameters and noise; then the thresholds, and again.
void settle(const MacroEstimator& estimator, const MacroBuild& build, MacroFit& fit) {
    const auto refine = [&] { refine_with_noise(estimator, fit.point, fit.active); };
    refine();
    if (build.dead_zone) {
        search_thresholds(estimator, fit.point, fit.active);
        refine();
        search_thresholds(estimator, fit.point, fit.active);
    }
    fit.influences = estimator.influences(fit.point, fit.active);
    if (build.dead_zone) {
        const double allowance = loss_allowance(fit);
        fit.forward = threshold_interval(estimator, fit.point, fit.active, +1.0, allowance);
        fit.backward = threshold_interval(estimator, fit.point, fit.active, -1.0, allowance);
    }
}

/// Whether the carriage was driven by one size of command alone, to a twentieth.
bool has_one_amplitude(const std::vector<MacroWindow>& windows, const MacroMotion& motion) {
    constexpr double twentieth = 0.05;
    double low_V = std::numeric_limits<double>::infinity(), high_V = 0.0;
    for (const MacroWindow& window : windows)
        for (const double u : window.command_V) {
            if (drive_speed_mm_per_s(motion, u) == 0.0 || u == 0.0) continue;
            low_V = std::min(low_V, std::abs(u));
            high_V = std::max(high_V, std::abs(u));
        }
    return !(high_V - low_V > twentieth * 0.5 * (high_V + low_V));
}

/// Whether friction lies at its bound of 0: nearer than a hundredth of its standard error.
bool at_bound(const MacroFit& fit) {
    constexpr double share = 0.01;
    return fit.active[macro_index::friction] &&
           fit.point.motion.friction_mm_per_s <= share * parameter_std(fit, macro_index::friction);
}

/// Friction and offset that the data cannot tell from the rest leave the fit, so that the rest is determined.
void drop_undetermined(const MacroEstimator& estimator, const MacroBuild& build, MacroFit& fit) {
    constexpr double most_share = 0.2, level = 0.01;
    const double drive_V = mean_drive_V(estimator.windows(), fit.point.motion);
    const auto drop = [&](int index, double most_std, std::optional<MacroFit::Dropped>& dropped) {
        if (!fit.active[static_cast<std::size_t>(index)]) return;
        const BatchVariance variance = variance_along(fit.influences, MacroVector::Unit(index));
        const double std = std::sqrt(variance.variance), value = vector_of(fit.point.motion)[index];
        if (std <= most_std || std::abs(value) > student_bound(variance.freedom, level) * std) return;
        dropped = {value, std, fit.point.motion};
        if (index == macro_index::friction) fit.friction_at_bound = at_bound(fit);
        fit.active[static_cast<std::size_t>(index)] = false;
        MacroVector parameters = vector_of(fit.point.motion);
        parameters[index] = 0.0;
        fit.point.motion = with_parameters(fit.point.motion, parameters);
        settle(estimator, build, fit);
    };
    drop(macro_index::friction, most_share * estimator.fastest_mm_per_s(), fit.friction_dropped);
    drop(macro_index::offset, most_share * drive_V, fit.offset_dropped);
}

/// A carriage that is driven to one side is held while no command drives it, or creeps there if its offset
/// overcomes friction; then offset less friction shows. It is in the fit where it shows beyond doubt, and
/// counts as what was taken as zero where it does not.
void weigh_creep(const MacroEstimator& estimator, const MacroBuild& build, MacroFit& fit) {
    constexpr double beyond_doubt = 1e-4;
    MacroFit creeping = fit;
    creeping.active[macro_index::offset] = true;
    settle(estimator, build, creeping);
    const BatchVariance variance =
        variance_along(creeping.influences, MacroVector::Unit(macro_index::offset));
    const double std = std::sqrt(variance.variance), value = creeping.point.motion.offset_V;
    if (!std::isfinite(value) || !(std > 0.0)) return;
    if (std::abs(value) > student_bound(variance.freedom, beyond_doubt) * std) {
        creeping.offset_less_friction = true;
        fit = std::move(creeping);
    } else {
        fit.offset_dropped = {value, std, creeping.point.motion};
    }
}

}  // namespace

double mean_drive_V(const std::vector<MacroWindow>& windows, const MacroMotion& motion) {
    double sum_V = 0.0, ticks = 0.0;
    for (const MacroWindow& window : windows) {
        for (const double u : window.command_V) {
            if (u == 0.0 || (u < motion.forward_threshold_V && -u < motion.backward_threshold_V)) continue;
            sum_V += std::abs(u);
            ++ticks;
        }
    }
    return ticks > 0.0 ? sum_V / ticks : 1.0;
}

double loss_allowance(const MacroFit& fit) {
    constexpr double independent = 2.0;
    double largest = 1.0;
    for (int i = 0; i < macro_parameter_count; ++i)
        if (const double claimed = fit.influences.inverse(i, i); claimed > 0.0)
            largest =
                std::max(largest, variance_along(fit.influences, MacroVector::Unit(i)).variance / claimed);
    return independent * largest;
}

double parameter_std(const MacroFit& fit, int index) {
    return std::sqrt(variance_along(fit.influences, MacroVector::Unit(index)).variance);
}

void refine_with_noise(const MacroEstimator& estimator, MacroPoint& point, const MacroActive& active) {
    constexpr int most_rounds = 6, iterations = 30;
    constexpr double same = 0.02;
    for (int round = 0; round < most_rounds; ++round) {
        const double noise_count = point.noise_count;
        point.noise_count = estimator.noise_count(point);
        estimator.refine(point, active, iterations);
        if (std::abs(noise_count - point.noise_count) < same * noise_count) break;
    }
}

std::vector<MacroWindow> macro_windows(std::span<const MacroTrace> traces, const MacroBuild& build,
                                       double window_s) {
    std::vector<MacroWindow> windows;
    for (const MacroTrace& trace : traces) {
        const auto free = free_ticks(trace, build.resolution_mm, build.travel);
        for (const MacroWindow& window : cut_windows(trace, free, window_s, least_piece_s))
            windows.push_back(window);
    }
    return windows;
}

Status check_macro_windows(const std::vector<MacroWindow>& windows, double resolution_mm) {
    constexpr double least_way_count = 4.0;
    if (windows.empty())
        return failure(
            Reason::not_identifiable,
            fmt::format("no stretch of {} ms away from the ends of travel", 1000.0 * least_piece_s));
    double way_mm = 0.0, command_V = 0.0;
    for (const MacroWindow& window : windows) {
        const auto [low, high] = std::minmax_element(window.position_mm.begin(), window.position_mm.end());
        way_mm = std::max(way_mm, *high - *low);
        for (const double u : window.command_V) command_V = std::max(command_V, std::abs(u));
    }
    if (command_V == 0.0)
        return failure(Reason::not_identifiable,
                       "the command was zero throughout, so nothing drove the carriage");
    if (way_mm < least_way_count * resolution_mm)
        return failure(
            Reason::not_identifiable,
            fmt::format("the carriage never moved under commands up to {:.3g} V: all that follows is that "
                        "friction holds it there",
                        command_V));
    return {};
}

MacroFit fit_macro_windows(const MacroEstimator& estimator, const MacroBuild& build) {
    MacroFit fit;
    fit.active = {build.dead_zone, true, true, false, true};
    fit.point = first_point(estimator, build, fit);
    if (!(fit.point.motion.time_constant_s > 0.0)) return fit;
    if (build.dead_zone) scan_thresholds(estimator, fit);
    fit.both_ways = drives_both_ways(estimator.windows(), fit.point.motion);
    fit.active[macro_index::offset] = fit.both_ways;
    const auto [reversals, coasted_s] = manoeuvres(estimator, fit.point.motion);
    // Motion at one constant speed determines only the difference of drive and friction, not each of them.
    fit.active[macro_index::friction] = reversals > 0 || coasted_s > 0.0 || build.dead_zone ||
                                        !has_one_amplitude(estimator.windows(), fit.point.motion);
    if (!fit.active[macro_index::friction]) fit.point.motion.friction_mm_per_s = 0.0;
    settle(estimator, build, fit);
    constexpr double shows = 0.2;  // of the largest speed
    if (!fit.both_ways && !build.dead_zone && at_bound(fit) &&
        parameter_std(fit, macro_index::friction) < shows * estimator.fastest_mm_per_s()) {
        fit.offset_less_friction = true;
        fit.active[macro_index::friction] = false;
        fit.active[macro_index::offset] = true;
        settle(estimator, build, fit);
    }
    if (!fit.both_ways && !build.dead_zone && !fit.offset_less_friction && !fit.active[macro_index::friction])
        weigh_creep(estimator, build, fit);
    drop_undetermined(estimator, build, fit);
    fit.friction_at_bound = fit.friction_at_bound || at_bound(fit);
    return fit;
}

void compare_minima(const MacroEstimator& estimator, const MacroBuild& build, MacroFit& fit) {
    std::vector<MacroMinimum> others = other_minima(estimator, fit);
    if (!others.empty() && others.front().above < 0.0) {
        MacroMinimum before{fit.point, -others.front().above};
        fit.point = others.front().point;
        settle(estimator, build, fit);
        others.front() = before;
    }
    const double allowance = loss_allowance(fit);
    for (const MacroMinimum& other : others)
        if (other.above < allowance) fit.rivals.push_back(other.point.motion);
}

}  // namespace fidservo::calib
