// SPDX-License-Identifier: GPL-3.0-or-later
// The macro stage in open loop: identified as published, then predicted with the plain dead zone (eq. 5) and
// with the modified one (eq. 7, fig. 9).
#include "calib/macro/macro_step_response.h"
#include "core/input_error.h"
#include "core/result.h"
#include "core/rig.h"
#include "src/reproduce/chapters.h"
#include "src/reproduce/figures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace fidservo::reproduce {

namespace {

/// The published procedure's findings.
struct Published {
    calib::MacroEstimate threshold_V;
    calib::StepModel step;
    calib::DeadZoneModel zone;
};

template <class T>
T demanded(const Result<T>& result, const char* what) {
    if (!result) throw RunFault(fmt::format("identification of {}: {}", what, result.error().text));
    return *result;
}

calib::MacroTrace trace_of(const Laboratory& laboratory, const std::string& name, double start_mm,
                           double duration_s, Course command_V) {
    const Recording recording = perform(
        laboratory, name,
        {.kind = name, .duration_s = duration_s, .carriage_mm = start_mm, .macro_V = std::move(command_V)});
    return calib::macro_traces(recording, laboratory.rig.macro.encoder_resolution_mm).at(0);
}

/// What a dead zone leaves of the commands.
std::vector<double> effective_V(const calib::MacroTrace& trace, double threshold_V,
                                const calib::DeadZoneModel& zone) {
    std::vector<double> volts(trace.command_V.size());
    std::ranges::transform(trace.command_V, volts.begin(), [&](double u_V) {
        return std::abs(u_V) < threshold_V
                   ? 0.0
                   : std::copysign(zone.offset_V + zone.slope * (std::abs(u_V) - threshold_V), u_V);
    });
    return volts;
}

Published identify_as_published(const Laboratory& laboratory) {
    constexpr double lowest_V = 2.803, rise_V = 0.01, hold_s = 0.1, unit_V = 4.0, step_s = 0.4,
                     start_mm = 20.0;
    constexpr std::array amplitudes_V{3.3, 3.6, 4.0, 4.5};
    const double resolution_mm = laboratory.rig.macro.encoder_resolution_mm;
    const auto rising = trace_of(laboratory, "dc-rising", 60.0, 2.5, [=](double t_s) {
        return lowest_V + rise_V * std::floor(t_s / hold_s + 1e-9);
    });
    const auto threshold =
        demanded(calib::threshold_from_rising_steps(rising, resolution_mm, 1.0), "the threshold");

    std::vector<calib::SteadySpeed> speeds;
    std::vector<calib::MacroTrace> traces;
    for (const double amplitude_V : amplitudes_V) {
        traces.push_back(trace_of(laboratory, fmt::format("step-{:.1f}V", amplitude_V), start_mm, step_s,
                                  [=](double) { return amplitude_V; }));
        const std::vector<double> one(traces.back().command_V.size(), 1.0);
        speeds.push_back(
            {amplitude_V,
             demanded(calib::step_model(traces.back(), one, resolution_mm), "a step").gain_mm_per_s_per_V});
    }
    const auto zone =
        demanded(calib::dead_zone_from_amplitudes(speeds, threshold.value, unit_V), "the dead zone");
    constexpr std::size_t one_volt = 2;
    const auto step =
        demanded(calib::step_model(traces[one_volt], effective_V(traces[one_volt], threshold.value, zone),
                                   resolution_mm),
                 "the transfer function");
    return {threshold, step, zone};
}

/// Position in mm that a model predicts from the commands alone.
std::vector<double> predict(const calib::MacroTrace& trace, const Published& found,
                            const calib::DeadZoneModel& zone) {
    const double threshold_V = found.threshold_V.value, gain = zone.gain_mm_per_s_per_V;
    const calib::MacroPropagation model({.speed_mm_per_s = gain * zone.offset_V,
                                         .slope_mm_per_s_per_V = gain * zone.slope,
                                         .centre_V = threshold_V,
                                         .time_constant_s = found.step.time_constant_s,
                                         .forward_threshold_V = threshold_V,
                                         .backward_threshold_V = threshold_V},
                                        trace.tick_s);
    calib::MacroMotionState state{trace.position_mm.front(), 0.0};
    std::vector<double> positions(trace.command_V.size());
    for (std::size_t k = 0; k < positions.size(); ++k) {
        positions[k] = state.position_mm;
        model.advance(state, trace.command_V[k]);
    }
    return positions;
}

double rms_difference(const std::vector<double>& a, const std::vector<double>& b) {
    double squares = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) squares += (a[k] - b[k]) * (a[k] - b[k]);
    return std::sqrt(squares / static_cast<double>(a.size()));
}

Claim within(const char* source, const char* claim, double found, double published, double share,
             const char* unit) {
    const double error = found / published - 1.0;
    return {source, claim, fmt::format("{:.4g} {} ({:+.2f} %)", found, unit, 100.0 * error),
            holds_if(std::abs(error) <= share), ""};
}

}  // namespace

Chapter open_loop_macro(const Laboratory& laboratory) {
    constexpr double amplitude_V = 4.2, frequency_hz = 1.0, duration_s = 6.0, start_mm = 80.0;
    const Published found = identify_as_published(laboratory);
    const auto trace = trace_of(laboratory, "open-loop-sine", start_mm, duration_s, [](double t_s) {
        return amplitude_V * std::sin(2.0 * std::numbers::pi * frequency_hz * t_s);
    });
    const std::vector<double> modified = predict(trace, found, found.zone);
    const std::vector<double> plain = predict(
        trace, found, {.gain_mm_per_s_per_V = found.zone.gain_mm_per_s_per_V, .offset_V = 0.0, .slope = 1.0});
    const double modified_mm = rms_difference(modified, trace.position_mm),
                 plain_mm = rms_difference(plain, trace.position_mm);
    const MacroParameters& macro = laboratory.rig.macro;

    Chapter chapter{"open-loop", "The macro stage in open loop", "", {}};
    chapter.html =
        time_figure("open-loop",
                    "Fig. 9 from our data: a sine that crosses the dead zone, on the stage and as two models "
                    "predict it from the "
                    "commands alone. Both know the threshold; only the modified dead zone knows that the "
                    "carriage leaves it with "
                    "speed.",
                    trace.tick_s,
                    {{"Carriage",
                      "mm",
                      {{"dead zone (eq. 5)", plain, false, 2},
                       {"modified dead zone (eq. 7)", modified, false, 2},
                       {"stage", trace.position_mm, false, 2}}},
                     {"Motor command", "V", {{"motor", trace.command_V, false}}, 140}}) +
        table_html(
            {"identified as published", "value", "rig"},
            {{"threshold, V", fmt::format("{:.4f} +- {:.4f}", found.threshold_V.value, found.threshold_V.std),
              fmt::format("{:.4f}", macro.dead_zone.threshold_V)},
             {"a0", fmt::format("{:.4f}", found.zone.offset_V),
              fmt::format("{:.4f}", macro.dead_zone.offset_V)},
             {"delta", fmt::format("{:.4f}", found.zone.slope), fmt::format("{:.4f}", macro.dead_zone.slope)},
             {"gain, mm/s/V", fmt::format("{:.2f}", found.zone.gain_mm_per_s_per_V),
              fmt::format("{:.2f}", macro.velocity_gain_mm_per_s_per_V)},
             {"pole", fmt::format("{:.5f}", found.step.pole), fmt::format("{:.5f}", macro.velocity_pole)},
             {"numerator, count/V", fmt::format("{:.5f}", found.step.numerator_count_per_V),
              fmt::format("{:.5f}", macro.velocity_gain_mm_per_s_per_V * (1.0 - macro.velocity_pole) *
                                        laboratory.rig.tick_s / macro.encoder_resolution_mm)}});
    chapter.claims = {
        within("eq. 6", "A step of one effective volt gives the transfer function: its gain.",
               found.step.gain_mm_per_s_per_V, macro.velocity_gain_mm_per_s_per_V, 0.01, "mm/s/V"),
        within("eq. 6", "A step of one effective volt gives the transfer function: its time constant.",
               1e3 * found.step.time_constant_s, -1e3 * laboratory.rig.tick_s / std::log(macro.velocity_pole),
               0.01, "ms"),
        within("eq. 7", "Steps of several amplitudes give the modified dead zone: a0.", found.zone.offset_V,
               macro.dead_zone.offset_V, 0.02, ""),
        within("eq. 7", "Steps of several amplitudes give the modified dead zone: delta.", found.zone.slope,
               macro.dead_zone.slope, 0.02, ""),
        {"fig. 9", "The modified dead zone follows the stage in open loop; the plain dead zone does not.",
         fmt::format("r.m.s. error {:.3f} mm against {:.1f} mm over {:.0f} s", modified_mm, plain_mm,
                     duration_s),
         holds_if(modified_mm < 0.1 * plain_mm && modified_mm < 0.5), ""}};
    return chapter;
}

}  // namespace fidservo::reproduce
