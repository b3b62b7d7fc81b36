#include "calib/axis/macro_identification.h"

#include "calib/axis/macro_fit.h"
#include "core/demand.h"
#include "core/failure.h"
#include "core/macro_parameters.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace fidservo::calib {

namespace {

constexpr double longest_window_s = 1.0, shortest_window_s = 0.125;

/// A relative standard error beyond which a figure is no figure.
constexpr double most_relative_std = 0.2;

std::vector<MacroTrace> within_limit(std::span<const MacroTrace> traces, double limit_V) {
    std::vector<MacroTrace> result(traces.begin(), traces.end());
    for (MacroTrace& trace : result)
        for (double& u : trace.command_V) u = std::clamp(u, -limit_V, limit_V);
    return result;
}

/// Threshold of the dead zone on the force w = u + b, from the thresholds on u in each direction.
struct Threshold {
    Result<MacroEstimate> identified;
    double value_V = 0.0;  ///< for a0
    double std_V = 0.0;
    bool assumed = false;
};

Result<MacroEstimate> direction_threshold(const ThresholdInterval& interval, const char* side) {
    if (!interval.bounded())
        return failure(Reason::not_identifiable,
                       fmt::format("no command to the {} moved the carriage", side));
    if (interval.std_V() > most_relative_std * 0.5 * interval.middle_V())
        return failure(
            Reason::not_identifiable,
            fmt::format("bounded only: between {:.4g} and {:.4g} V to the {} no command was tried from rest; "
                        "commands that rise slowly through it would tell",
                        interval.above_V, interval.most_V, side));
    return MacroEstimate{interval.middle_V(), interval.std_V()};
}

Threshold find_threshold(const MacroFit& fit, const MacroBuild& build) {
    const auto forward = direction_threshold(fit.forward, "right");
    const auto backward = direction_threshold(fit.backward, "left");
    const double offset_V = fit.point.motion.offset_V;
    if (forward && backward) {
        const double std_V = 0.5 * std::hypot(forward->std, backward->std);
        const double value_V = 0.5 * (forward->value + backward->value);
        return {MacroEstimate{value_V, std_V}, value_V, std_V};
    }
    if (forward || backward) {
        const double value_V = forward ? forward->value + offset_V : backward->value - offset_V;
        const double std_V = forward ? forward->std : backward->std;
        return {MacroEstimate{value_V, std_V}, value_V, std_V};
    }
    return {tl::make_unexpected(fit.forward.bounded() ? forward.error() : backward.error()),
            build.threshold_V, 0.0, true};
}

/// What people call the fitted speeds: K, tau, a0, delta, F, b.
using Figures = Eigen::Matrix<double, 6, 1>;

Figures figures_of(const MacroMotion& motion, double unit_V, double threshold_V) {
    const auto line = [&](double size_V) {
        return motion.speed_mm_per_s + motion.slope_mm_per_s_per_V * (size_V - motion.centre_V);
    };
    const double gain = line(unit_V);
    return {gain,
            motion.time_constant_s,
            line(threshold_V) / gain,
            motion.slope_mm_per_s_per_V / gain,
            motion.friction_mm_per_s / gain,
            motion.offset_V};
}

/// First-order propagation of the fit's covariance and of the threshold's standard error.
Figures figure_stds(const MacroFit& fit, double unit_V, const Threshold& threshold) {
    const MacroVector here = vector_of(fit.point.motion);
    const auto at = [&](const MacroVector& parameters) {
        MacroMotion motion = with_parameters(fit.point.motion, parameters);
        motion.friction_mm_per_s = parameters[macro_index::friction];
        return figures_of(motion, unit_V, threshold.value_V);
    };
    Eigen::Matrix<double, 6, macro_parameter_count> gradient;
    for (int i = 0; i < macro_parameter_count; ++i) {
        const double step = 1e-6 * std::max(1e-3, std::abs(here[i]));
        MacroVector above = here, below = here;
        above[i] += step;
        below[i] -= step;
        gradient.col(i) = (at(above) - at(below)) / (2.0 * step);
    }
    Figures variance = (gradient * fit.covariance * gradient.transpose()).diagonal();
    const double zone_slope = figures_of(fit.point.motion, unit_V, threshold.value_V)[3];
    variance[2] += std::pow(zone_slope * threshold.std_V, 2);
    return variance.cwiseMax(0.0).cwiseSqrt();
}

Result<MacroEstimate> judged(double value, double std, double most_std, const std::string& why_not) {
    if (std::isfinite(value) && std <= most_std) return MacroEstimate{value, std};
    return failure(Reason::not_identifiable, fmt::format("{} (standard error {:.2g})", why_not, std));
}

void give_dead_zone(MacroIdentification& result, const MacroFit& fit, const MacroBuild& build,
                    const Figures& value, const Figures& std, const Threshold& threshold) {
    if (!build.dead_zone) {
        const auto none = failure(Reason::not_identifiable, "the rig has no dead zone");
        result.threshold_V = none;
        result.zone_offset_V = none;
        result.zone_slope = none;
        return;
    }
    result.threshold_V = threshold.identified;
    const std::string one_amplitude = fmt::format(
        "the commands that drove lie too close around {:.3g} V to tell a0 from delta: several amplitudes "
        "would",
        fit.point.motion.centre_V);
    result.zone_slope = judged(value[3], std[3], most_relative_std * std::abs(value[3]), one_amplitude);
    const bool in_bounds = !fit.forward.bounded() || (build.threshold_V > fit.forward.above_V &&
                                                      build.threshold_V <= fit.forward.most_V);
    if (threshold.assumed && !in_bounds)
        result.zone_offset_V = failure(
            Reason::not_identifiable,
            "a0 is the effective voltage at the threshold, which these data leave open and the rig file "
            "gives outside of what they allow");
    else
        result.zone_offset_V = judged(value[2], std[2], most_relative_std, one_amplitude);
    result.threshold_assumed = threshold.assumed && result.zone_offset_V.has_value();
}

MacroIdentification identification(const MacroFit& fit, const MacroBuild& build) {
    const Threshold threshold = build.dead_zone ? find_threshold(fit, build) : Threshold{};
    const MacroMotion& motion = fit.point.motion;
    const Figures value = figures_of(motion, build.unit_V, threshold.value_V);
    const Figures std = figure_stds(fit, build.unit_V, threshold);
    MacroIdentification result{};
    result.gain_mm_per_s_per_V =
        judged(value[0], std[0], most_relative_std * std::abs(value[0]),
               build.dead_zone
                   ? fmt::format(
                         "the gain is the speed at {:.3g} V, and the commands that drove lie around {:.3g} V",
                         build.unit_V, motion.centre_V)
                   : "the motion is too short or too slow to show the speed it tends to");
    result.time_constant_s = judged(
        value[1], std[1], most_relative_std * value[1],
        "no start, stop or reversal shows how fast the speed changes: too short, too slow, or too coarse");
    give_dead_zone(result, fit, build, value, std, threshold);
    result.friction_V =
        fit.active[macro_index::friction]
            ? Result<MacroEstimate>(MacroEstimate{value[4], std[4]})
            : failure(
                  Reason::not_identifiable,
                  "friction and drive cannot be told apart without the carriage coasting or reversing; taken "
                  "as zero");
    result.drive_offset_V =
        fit.active[macro_index::offset]
            ? Result<MacroEstimate>(MacroEstimate{value[5], std[5]})
            : failure(Reason::not_identifiable,
                      fit.both_ways ? "offset and friction cannot be told apart in these data; taken as zero"
                                    : "the carriage was driven to one side only; taken as zero");
    result.motion = motion;
    return result;
}

double recorded_s(std::span<const MacroTrace> traces) {
    double total_s = 0.0;
    for (const MacroTrace& trace : traces)
        total_s += static_cast<double>(trace.position_mm.size()) * trace.tick_s;
    return total_s;
}

}  // namespace

MacroBuild macro_build(const MacroParameters& macro) {
    const DeadZone& zone = macro.dead_zone;
    return {.resolution_mm = macro.encoder_resolution_mm,
            .travel = {macro.low_mm, macro.high_mm},
            .command_limit_V = macro.command_limit_V,
            .dead_zone = zone.threshold_V > 0.0,
            .unit_V = zone.threshold_V + (1.0 - zone.offset_V) / zone.slope,
            .threshold_V = zone.threshold_V};
}

Result<MacroIdentification> identify_macro(std::span<const MacroTrace> traces, const MacroBuild& build) {
    FIDSERVO_DEMAND(build.resolution_mm > 0.0 && build.command_limit_V > 0.0);
    const std::vector<MacroTrace> limited = within_limit(traces, build.command_limit_V);
    for (double window_s = longest_window_s;; window_s *= 0.5) {
        const std::vector<MacroWindow> windows = macro_windows(limited, build, window_s);
        if (const Status usable = check_macro_windows(windows, build.resolution_mm); !usable)
            return tl::make_unexpected(usable.error());
        const MacroEstimator estimator(windows, build.resolution_mm);
        const MacroFit fit = fit_macro_windows(estimator, build);
        if (!fit.covariance.allFinite() || !vector_of(fit.point.motion).allFinite())
            return failure(Reason::no_convergence,
                           "no model with finite parameters follows these recordings");
        if (estimator.noise_count(fit.point) > 1.0 && window_s > shortest_window_s) continue;
        MacroIdentification result = identification(fit, build);
        result.residual_count = estimator.residual_count(fit.point);
        result.window_s = window_s;
        result.windows = static_cast<int>(windows.size());
        for (const MacroWindow& window : windows)
            result.used_s += static_cast<double>(window.position_mm.size()) * window.tick_s;
        result.left_out_s = recorded_s(limited) - result.used_s;
        return result;
    }
}

}  // namespace fidservo::calib
