// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/macro/macro_identification.h"

#include "calib/macro/macro_fit.h"
#include "calib/macro/macro_knowledge.h"
#include "calib/tails.h"
#include "core/demand.h"
#include "core/failure.h"
#include "core/macro_parameters.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace fidservo::calib {

namespace {

constexpr double longest_window_s = 1.0, shortest_window_s = 0.125;

/// A relative standard error beyond which a threshold is no figure.
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

/// Whether an interval of 95 % is wider than one of a normal law with such a standard error.
bool wider_than(const MacroEstimate& estimate, double std) {
    return !(std::isfinite(estimate.value) && estimate.reach_95() <= normal_95 * std);
}

constexpr std::array<const char*, macro_figure_count> figure_names{
    "gain", "time constant", "offset of the dead zone", "slope of the dead zone", "friction", "drive offset"};

/// K / tau where that is known to a fifth.
std::optional<MacroEstimate> ratio_of_gain_and_time_constant(const MacroFit& fit, const MacroBuild& build,
                                                             const MacroKnowledge& known) {
    constexpr double fifth = 0.2;
    const MacroFigureGradient gradient = figure_gradient(fit.point.motion, build.unit_V, 0.0);
    const double gain = known.value[0], tau_s = known.value[1];
    const MacroVector relative = (gradient.row(0) / gain - gradient.row(1) / tau_s).transpose();
    const BatchVariance variance = variance_along(fit.influences, relative);
    const double std = std::sqrt(variance.variance);
    if (!(std < fifth) || known.agreement[0].scatter.added_variance > 0.0) return std::nullopt;
    const double ratio = gain / tau_s;
    return MacroEstimate{ratio, std::abs(ratio) * std, variance.freedom};
}

std::string with_std(const MacroEstimate& estimate) {
    return fmt::format("{:.4g} +- {:.2g}", estimate.value, estimate.std);
}

MacroContradiction contradiction_on(const MacroKnowledge& known, std::size_t figure,
                                    const std::vector<std::string>& names) {
    const MacroAgreement& agreement = known.agreement[figure];
    const auto own = [&](std::size_t i) {
        return MacroEstimate{agreement.own[i].value, agreement.own[i].std, agreement.own[i].freedom};
    };
    const auto [low, high] = std::pair(agreement.scatter.low, agreement.scatter.high);
    return {figure_names[figure],
            agreement.scatter.apart,
            names[agreement.recordings[low]],
            names[agreement.recordings[high]],
            own(low),
            own(high)};
}

/// Another minimum's value where it is another.
std::optional<double> rival_value(const MacroFit& fit, const MacroKnowledge& known, MacroFigure figure,
                                  double unit_V, double threshold_V) {
    const auto i = static_cast<int>(figure);
    for (const MacroMotion& rival : fit.rivals) {
        const double value = figures_of(rival, unit_V, threshold_V)[i];
        if (std::abs(value - known.value[i]) > estimate_of(known, figure).reach_95()) return value;
    }
    return std::nullopt;
}

/// A figure, or why these data do not determine it.
class Judge {
  public:
    Judge(const MacroFit& fit, const MacroBuild& build, const MacroKnowledge& known, double threshold_V,
          const std::vector<MacroContradiction>& contradictions)
        : fit_(fit),
          build_(build),
          known_(known),
          threshold_V_(threshold_V),
          contradictions_(contradictions) {}

    Result<MacroEstimate> operator()(MacroFigure figure, const std::string& too_wide) const {
        const MacroEstimate estimate = estimate_of(known_, figure);
        const auto i = static_cast<int>(figure);
        if (const auto other = rival_value(fit_, known_, figure, build_.unit_V, threshold_V_))
            return failure(
                Reason::not_identifiable,
                fmt::format("two values fit about equally well, {:.4g} and {:.4g}: the data do not "
                            "decide",
                            estimate.value, *other));
        if (!wider_than(estimate, known_.most_std[i])) return estimate;
        for (const MacroContradiction& found : contradictions_)
            if (found.figure == figure_names[static_cast<std::size_t>(i)])
                return failure(Reason::not_identifiable,
                               fmt::format("the recordings contradict each other by {:.1f} standard errors, "
                                           "{} says {}, {} says {}: no common value",
                                           found.apart, found.low_recording, with_std(found.low),
                                           found.high_recording, with_std(found.high)));
        return failure(Reason::not_identifiable,
                       fmt::format("{} (standard error {:.2g})", too_wide, estimate.std));
    }

  private:
    const MacroFit& fit_;
    const MacroBuild& build_;
    const MacroKnowledge& known_;
    double threshold_V_;
    const std::vector<MacroContradiction>& contradictions_;
};

void give_dead_zone(MacroIdentification& result, const MacroFit& fit, const MacroBuild& build,
                    const Judge& judged, const Threshold& threshold) {
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
    result.zone_slope = judged(MacroFigure::zone_slope, one_amplitude);
    const bool in_bounds = !fit.forward.bounded() || (build.threshold_V > fit.forward.above_V &&
                                                      build.threshold_V <= fit.forward.most_V);
    if (threshold.assumed && !in_bounds)
        result.zone_offset_V = failure(
            Reason::not_identifiable,
            "a0 is the effective voltage at the threshold, which these data leave open and the rig file "
            "gives outside of what they allow");
    else
        result.zone_offset_V = judged(MacroFigure::zone_offset, one_amplitude);
    result.threshold_assumed = threshold.assumed && result.zone_offset_V.has_value();
}

/// Why offset and friction are refused if the carriage was driven to one side only: only their difference is
/// determined.
std::string net_offset_refusal(const MacroKnowledge& known) {
    return fmt::format(
        "the carriage was driven to one side only: drive offset less friction is {} V, each alone "
        "is not determined",
        with_std(estimate_of(known, MacroFigure::drive_offset)));
}

/// Why friction left the fit; a cause is named only where it is there.
std::string friction_refusal(const MacroFit& fit, const MacroIdentification& result) {
    if (fit.offset_less_friction)
        return "the carriage was driven to one side only: drive offset less friction is determined, each "
               "alone is "
               "not";
    if (result.reversals == 0 && result.coasted_s == 0.0)
        return "friction and drive cannot be told apart: the carriage neither coasted nor reversed; taken as "
               "zero";
    const std::string seen = result.coasted_s > 0.0
                                 ? fmt::format("the carriage reversed {} times and coasted for {:.2g} s",
                                               result.reversals, result.coasted_s)
                                 : fmt::format("the carriage reversed {} times", result.reversals);
    if (!fit.friction_dropped) return "it does not show, though " + seen + "; taken as zero";
    const std::string value = fit.friction_at_bound ? "it came out at its bound of 0"
                                                    : fmt::format("it came out at {:.3g} mm/s of speed lost",
                                                                  fit.friction_dropped->value);
    return fmt::format("{} with a standard error of {:.2g} mm/s, though {}; taken as zero", value,
                       fit.friction_dropped->std, seen);
}

MacroIdentification identification(const MacroEstimator& estimator, const MacroFit& fit,
                                   const MacroBuild& build, const std::vector<std::string>& names) {
    const Threshold threshold = build.dead_zone ? find_threshold(fit, build) : Threshold{};
    const MacroMotion& motion = fit.point.motion;
    const MacroKnowledge known = knowledge_of(estimator, fit, build, threshold.value_V, threshold.std_V);
    MacroIdentification result{};
    for (const std::size_t figure : contradicted(known))
        result.contradictions.push_back(contradiction_on(known, figure, names));
    const Judge judged(fit, build, known, threshold.value_V, result.contradictions);
    const auto [reversals, coasted_s] = manoeuvres(estimator, motion);
    result.reversals = reversals;
    result.coasted_s = coasted_s;
    result.gain_mm_per_s_per_V =
        judged(MacroFigure::gain,
               build.dead_zone
                   ? fmt::format(
                         "the gain is the speed at {:.3g} V, and the commands that drove lie around {:.3g} V",
                         build.unit_V, motion.centre_V)
                   : "the motion is too short or too slow to show the speed it tends to");
    result.time_constant_s = judged(
        MacroFigure::time_constant,
        "no start, stop or reversal shows how fast the speed changes: too short, too slow, or too coarse");
    give_dead_zone(result, fit, build, judged, threshold);
    result.friction_V = fit.active[macro_index::friction]
                            ? judged(MacroFigure::friction, "it hardly shows, or not apart from the others")
                            : failure(Reason::not_identifiable, friction_refusal(fit, result));
    result.drive_offset_V =
        fit.offset_less_friction ? failure(Reason::not_identifiable, net_offset_refusal(known))
        : fit.active[macro_index::offset]
            ? judged(MacroFigure::drive_offset, "it hardly shows, or not apart from the others")
            : failure(Reason::not_identifiable,
                      fit.both_ways ? "offset and friction cannot be told apart in these data; taken as zero"
                                    : "the carriage was driven to one side only; taken as zero");
    result.friction_at_bound = fit.friction_at_bound;
    result.motion = motion;
    result.rivals = fit.rivals;
    for (const MacroLack& lack : known.lacks.found) result.missing.push_back({lack.depends_on, lack.share});
    result.missed_share = known.missed.share;
    result.white_noise_mm = known.missed.noise_count * build.resolution_mm;
    if (!result.gain_mm_per_s_per_V || !result.time_constant_s)
        result.acceleration_mm_per_s2_per_V = ratio_of_gain_and_time_constant(fit, build, known);
    return result;
}

std::vector<std::string> recording_names(std::span<const MacroTrace> traces) {
    std::vector<std::string> names;
    for (const MacroTrace& trace : traces) {
        if (names.size() <= trace.recording) names.resize(trace.recording + 1);
        names[trace.recording] = trace.name;
    }
    return names;
}

double recorded_s(std::span<const MacroTrace> traces) {
    double total_s = 0.0;
    for (const MacroTrace& trace : traces)
        total_s += static_cast<double>(trace.position_mm.size()) * trace.tick_s;
    return total_s;
}

}  // namespace

double MacroEstimate::reach_95() const {
    return std > 0.0 ? student_95(freedom) * std : std;
}

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
        MacroFit fit = fit_macro_windows(estimator, build);
        if (!fit.influences.inverse.allFinite() || !vector_of(fit.point.motion).allFinite())
            return failure(Reason::no_convergence,
                           "no model with finite parameters follows these recordings");
        if (estimator.noise_count(fit.point) > 1.0 && window_s > shortest_window_s) continue;
        compare_minima(estimator, build, fit);
        MacroIdentification result = identification(estimator, fit, build, recording_names(limited));
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
