// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/macro/macro_force.h"
#include "calib/macro/macro_identification.h"
#include "core/failure.h"
#include "core/input_error.h"
#include "core/result.h"
#include "core/rig.h"
#include "src/identify/identify.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo {

namespace {

using Estimate = Result<calib::MacroEstimate>;

void add(Identified& identified, const std::string& key, const std::string& unit, const Estimate& estimate,
         bool in_rig_file = true) {
    if (estimate)
        identified.values.push_back({key, unit, estimate->value, estimate->std, in_rig_file,
                                     wide_interval(estimate->value, estimate->std, estimate->freedom),
                                     estimate->systematic});
    else
        identified.undetermined.push_back({key, estimate.error().text});
}

/// Per tick: pole = exp(-T / tau).
Estimate velocity_pole(const Estimate& time_constant_s, double tick_s) {
    if (!time_constant_s) return time_constant_s;
    const double pole = std::exp(-tick_s / time_constant_s->value);
    const double slope_per_s = pole * tick_s / (time_constant_s->value * time_constant_s->value);
    return calib::MacroEstimate{pole, slope_per_s * time_constant_s->std, time_constant_s->freedom,
                                slope_per_s * time_constant_s->systematic};
}

/// Friction or offset that stands out of its standard error by three times belongs into the rig file.
void state_if_present(Identified& identified, const std::string& effect, const std::string& parameter,
                      const Estimate& estimate) {
    constexpr double significant = 3.0, least_V = 1e-3;
    if (estimate && std::abs(estimate->value) > std::max(least_V, significant * estimate->std))
        identified.effects.push_back({effect, {{parameter, estimate->value}}});
}

std::vector<calib::MacroTrace> traces_of(const IdentifyInput& input, Identified& identified) {
    std::vector<Recording> recordings = input.recordings;
    if (input.table) recordings.push_back(table_as_macro_recording(input));
    std::vector<calib::MacroTrace> traces;
    for (const Recording& recording : recordings) {
        if (!recording.columns.macro_command || !(recording.columns.encoder || recording.columns.position))
            throw InputError(
                fmt::format("{}: identify macro needs macro_command [V] and encoder [count] or position [mm]",
                            recording.name));
        identified.recordings.push_back(recording.name);
        for (calib::MacroTrace& trace : calib::macro_traces(recording, input.rig.macro.encoder_resolution_mm,
                                                            identified.recordings.size() - 1))
            traces.push_back(std::move(trace));
    }
    return traces;
}

/// Readings beyond the ends of travel show that the encoder's zero is not the rig file's.
void check_origin(calib::MacroBuild& build, const std::vector<calib::MacroTrace>& traces,
                  Identified& identified) {
    const auto beyond = [&](double y_mm) {
        return y_mm < build.travel.low_mm - build.resolution_mm ||
               y_mm > build.travel.high_mm + build.resolution_mm;
    };
    if (std::ranges::none_of(traces, [&](const calib::MacroTrace& trace) {
            return std::ranges::any_of(trace.position_mm, beyond);
        }))
        return;
    constexpr double infinity = std::numeric_limits<double>::infinity();
    build.travel = {-infinity, infinity};
    identified.notes.emplace_back(
        "readings lie beyond the rig file's travel: the encoder's zero is taken as unknown, and end stops "
        "are known "
        "only by the carriage stopping dead");
}

/// A dead zone whose offset is below 0 drives backwards at its threshold, which no friction does, and no rig
/// file takes: it begins where the effective voltage passes 0.
void begin_at_zero(calib::MacroIdentification& found) {
    if (!found.threshold_V || !found.zone_offset_V || !found.zone_slope) return;
    calib::MacroEstimate& offset_V = *found.zone_offset_V;
    if (offset_V.value >= 0.0 || found.zone_slope->value <= 0.0) return;
    found.threshold_V->value -= offset_V.value / found.zone_slope->value;
    found.threshold_V->std = std::max(found.threshold_V->std, offset_V.std / found.zone_slope->value);
    offset_V.value = 0.0;
}

void add_values(Identified& identified, const calib::MacroIdentification& found, const Rig& rig,
                bool dead_zone) {
    add(identified, "macro.velocity_gain_mm_per_s_per_V", "mm/s/V", found.gain_mm_per_s_per_V);
    add(identified, "macro.velocity_pole", "per tick", velocity_pole(found.time_constant_s, rig.tick_s));
    if (found.time_constant_s) add(identified, "time_constant", "s", found.time_constant_s, false);
    if (dead_zone) {
        add(identified, "macro.dead_zone.threshold_V", "V", found.threshold_V);
        add(identified, "macro.dead_zone.offset_V", "V", found.zone_offset_V);
        add(identified, "macro.dead_zone.slope", "V/V", found.zone_slope);
    }
    add(identified, "coulomb_friction", "V", found.friction_V, false);
    if (found.friction_V && found.friction_at_bound) {
        identified.values.back().interval = {0.0, found.friction_V->value + found.friction_V->reach_95()};
        identified.notes.emplace_back(
            "coulomb_friction came out at its bound of 0: its interval is one-sided");
    }
    add(identified, "drive_offset", "V", found.drive_offset_V, false);
    if (const auto& ratio = found.acceleration_mm_per_s2_per_V)
        add(identified, "gain_over_time_constant", "mm/s^2/V", *ratio, false);
    if (found.acceleration_mm_per_s2_per_V)
        identified.notes.emplace_back(
            "gain over time constant, the acceleration that a volt gives, is determined; each alone is not");
    state_if_present(identified, "coulomb_friction", "level_V", found.friction_V);
    state_if_present(identified, "drive_offset", "offset_V", found.drive_offset_V);
}

/// The largest share of the force that a model may miss: one that goes with the command moves the gain by its
/// own share, and a gain that is off by more than a fifth is not determined.
constexpr double most_missed = 0.2;

std::string percent(double share) {
    return share < 0.1 ? fmt::format("{:.2g} %", 100.0 * share) : fmt::format("{:.0f} %", 100.0 * share);
}

std::string remainder(const calib::MacroIdentification& found) {
    std::vector<std::string> parts;
    for (const calib::MacroMissing& missing : found.missing)
        parts.push_back(fmt::format("{} ({} of its squares)", missing.depends_on, percent(missing.share)));
    if (parts.empty()) return "none of position, speed, direction, command and time explains what is left";
    return fmt::format("what is left depends on {}", fmt::join(parts, ", "));
}

/// Why no number is to be had from a model that is not that of these recordings; empty if it is.
std::string model_refusal(const calib::MacroIdentification& found, const Result<double>& force_error) {
    const bool of_force = force_error && *force_error > most_missed;
    if (!of_force && !(found.missed_share.value_or(0.0) > most_missed)) return {};
    const std::string missed = of_force ? fmt::format("{} of the force", percent(*force_error))
                                        : fmt::format("{} of the force, integrated over windows of {:.4g} s",
                                                      percent(*found.missed_share), found.window_s);
    std::string text = fmt::format("the model misses {}; {}", missed, remainder(found));
    if (!found.friction_V) text += fmt::format("; friction: {}", found.friction_V.error().text);
    return text;
}

/// The figures on which recordings contradict each other, by their keys.
void add_contradictions(Identified& identified, const calib::MacroIdentification& found) {
    const std::map<std::string, std::string> macro_keys{
        {"gain", "macro.velocity_gain_mm_per_s_per_V"},
        {"time constant", "time_constant"},
        {"offset of the dead zone", "macro.dead_zone.offset_V"},
        {"slope of the dead zone", "macro.dead_zone.slope"},
        {"friction", "coulomb_friction"},
        {"drive offset", "drive_offset"}};
    for (const calib::MacroContradiction& of : found.contradictions)
        identified.contradictions.push_back({macro_keys.at(of.figure),
                                             of.apart,
                                             {of.low_recording, of.low.value, of.low.std},
                                             {of.high_recording, of.high.value, of.high.std}});
    for (const calib::MacroMissing& missing : found.missing)
        identified.missing.push_back({missing.depends_on, missing.share});
    identified.missed_share = found.missed_share;
}

void add_notes(Identified& identified, const calib::MacroIdentification& found,
               const calib::MacroBuild& build, const Result<double>& force_error) {
    identified.notes.push_back(
        fmt::format("{:.4g} s in {} windows of {:.4g} s{}", found.used_s, found.windows, found.window_s,
                    found.left_out_s > 1e-6
                        ? fmt::format("; {:.4g} s at end stops or in short pieces left out", found.left_out_s)
                        : ""));
    if (found.threshold_assumed)
        identified.notes.push_back(
            fmt::format("offset_V is for the rig file's threshold of {:.4g} V", build.threshold_V));
    if (build.dead_zone)
        identified.notes.push_back(
            fmt::format("the gain is for effective volts, 1 V at a command of {:.4g} V", build.unit_V));
    if (force_error) identified.notes.push_back("relative error of the force: " + percent(*force_error));
    if (!found.missing.empty())
        identified.notes.push_back(
            remainder(found) +
            ": the standard errors count by how much the values would move with that in the model");
}

}  // namespace

Identified identify_macro(const IdentifyInput& input) {
    constexpr double rounding_count = 0.2886751345948129;  // 1/sqrt(12)
    Identified identified{.part = "macro"};
    const std::vector<calib::MacroTrace> traces = traces_of(input, identified);
    calib::MacroBuild build = calib::macro_build(input.rig.macro);
    check_origin(build, traces, identified);
    auto found = calib::identify_macro(traces, build);
    if (!found) {
        identified.undetermined.push_back({"macro", found.error().text});
        return identified;
    }
    if (found->gain_mm_per_s_per_V && found->gain_mm_per_s_per_V->value <= 0.0) {
        identified.undetermined.push_back(
            {"macro", "the position falls where the command rises: one of the two has the wrong sign"});
        return identified;
    }
    begin_at_zero(*found);
    // At rest a dead zone holds what friction does not: the force is judged over windows alone.
    const Result<double> force_error =
        build.dead_zone ? Result<double>(failure(Reason::not_identifiable, "the rig has a dead zone"))
                        : calib::relative_force_error(traces, found->motion, found->white_noise_mm);
    add_contradictions(identified, *found);
    identified.residuals.push_back({"encoder", "count", found->residual_count, rounding_count});
    add_notes(identified, *found, build, force_error);
    if (const std::string refusal = model_refusal(*found, force_error); !refusal.empty())
        identified.undetermined.push_back({"macro", refusal});
    else
        add_values(identified, *found, input.rig, build.dead_zone);
    return identified;
}

}  // namespace fidservo
