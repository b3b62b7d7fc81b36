// SPDX-License-Identifier: GPL-3.0-or-later
// The PI with anti-windup on the micro stage: sequential steps (fig. 21), and bandwidth over the full travel.
#include "core/rig.h"
#include "src/report/xy_chart.h"
#include "src/reproduce/chapters.h"
#include "src/reproduce/figures.h"
#include "src/reproduce/step_response.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <span>

#include <fmt/format.h>

namespace fidservo::reproduce {

namespace {

constexpr double um_per_mm = 1e3;

/// Half the travel and back in one step each, then up and down in smaller ones.
Recording sequential_steps(const Laboratory& laboratory) {
    constexpr double hold_s = 4.0;
    const std::vector<double> places_mm{1.0, 3.0, 1.0, 1.6, 2.2, 2.8, 3.4, 2.8, 2.2, 1.6, 1.0};
    std::vector<double> times_s(places_mm.size());
    for (std::size_t i = 0; i < times_s.size(); ++i) times_s[i] = hold_s * static_cast<double>(i);
    return perform(laboratory, "pi-steps",
                   {.kind = "pi-steps",
                    .duration_s = hold_s * static_cast<double>(places_mm.size()),
                    .carriage_mm = 100.0,
                    .micro_setpoint_mm = steps(times_s, places_mm)});
}

struct MicroStep {
    StepResponse to_five_percent;
    StepResponse to_five_um;
};

std::vector<MicroStep> micro_responses(const Rig& rig, const Recording& recording,
                                       const std::vector<double>& platform) {
    constexpr double five_um_mm = 0.005, tail_s = 0.5;
    std::vector<MicroStep> found;
    double from_mm = 0.0;
    for (const HeldSetpoint& held : held_setpoints(column(recording, &StageRow::micro_setpoint_mm))) {
        const auto rows = std::span(platform).subspan(held.begin, held.end - held.begin);
        found.push_back({step_response(rows, from_mm, held.value, 0.05 * std::abs(held.value - from_mm),
                                       tail_s, rig.tick_s),
                         step_response(rows, from_mm, held.value, five_um_mm, tail_s, rig.tick_s)});
        from_mm = held.value;
    }
    return found;
}

std::string micro_response_table(const std::vector<MicroStep>& steps_made) {
    std::vector<std::vector<std::string>> rows;
    rows.reserve(steps_made.size());
    for (const auto& [percent, um] : steps_made)
        rows.push_back({fmt::format("{:.1f} to {:.1f}", percent.from, percent.to),
                        fmt::format("{:.2f}", percent.settling_s),
                        std::isfinite(um.settling_s) ? fmt::format("{:.2f}", um.settling_s) : "hunts",
                        fmt::format("{:.2f}", um_per_mm * um.final_error),
                        fmt::format("{:.2f}", um_per_mm * um.tail_rms)});
    return table_html({"step, mm", "within 5 % of the step after, s", "within 5 um after, s",
                       "mean error at the end, um", "r.m.s. error at the end, um"},
                      rows);
}

/// What becomes of a sine over the full travel, after its first period.
struct SineResponse {
    double frequency_hz;
    double gain;          ///< first harmonic of the platform over that of the set point
    double lag_deg;       ///< of the first harmonic
    double travel_share;  ///< what the platform covers of the travel, from peak to peak
};

SineResponse full_travel_sine(const Laboratory& laboratory, double frequency_hz) {
    constexpr int periods = 4;
    const MicroParameters& micro = laboratory.rig.micro.value();
    const double middle_mm = 0.5 * (micro.low_mm + micro.high_mm),
                 amplitude_mm = 0.5 * (micro.high_mm - micro.low_mm);
    const double omega = 2.0 * std::numbers::pi * frequency_hz;
    const Recording recording = perform(
        laboratory, fmt::format("pi-sine-{:.3f}hz", frequency_hz),
        {.kind = "pi-sine",
         .duration_s = periods / frequency_hz,
         .carriage_mm = 100.0,
         .micro_setpoint_mm = [=](double t_s) { return middle_mm - amplitude_mm * std::cos(omega * t_s); }});
    const std::vector<double> platform = platform_mm(laboratory.rig, recording);
    const std::vector<double> setpoint = column(recording, &StageRow::micro_setpoint_mm);
    const std::size_t first = platform.size() / periods;
    std::complex<double> output, input;
    for (std::size_t k = first; k < platform.size(); ++k) {
        const auto wave = std::polar(1.0, -omega * laboratory.rig.tick_s * static_cast<double>(k));
        output += platform[k] * wave;
        input += setpoint[k] * wave;
    }
    const auto [low, high] = std::ranges::minmax(std::span(platform).subspan(first));
    return {frequency_hz, std::abs(output / input), -std::arg(output / input) * 180.0 / std::numbers::pi,
            (high - low) / (2.0 * amplitude_mm)};
}

}  // namespace

Chapter micro_steps(const Laboratory& laboratory) {
    const Rig& rig = laboratory.rig;
    const Recording recording = sequential_steps(laboratory);
    const std::vector<double> platform = platform_mm(rig, recording);
    const std::vector<MicroStep> made = micro_responses(rig, recording, platform);
    const MicroStep& contraction = made.at(1);
    const MicroStep& extension = made.at(2);
    double worst_error_um = 0.0;
    for (const MicroStep& step : made)
        worst_error_um = std::max(worst_error_um, um_per_mm * std::abs(step.to_five_um.final_error));

    Chapter chapter{"pi", "The PI with anti-windup: sequential steps", "", {}};
    chapter.html =
        time_figure(
            "pi-steps",
            "Fig. 21 from our data: the platform on sequential steps. It contracts as fast as the heater "
            "can, and "
            "extends as fast as the wire cools; the anti-windup lets the command leave its limit in time.",
            rig.tick_s,
            {{"Platform",
              "mm",
              {{"set point", column(recording, &StageRow::micro_setpoint_mm), true, 3, true},
               {"platform (Hall sensor)", platform, false, 4}}},
             {"Heater command",
              "V",
              {{"heater", column(recording, &StageRow::micro_command_V), true}},
              160}}) +
        micro_response_table(made);
    chapter.claims = {
        {"fig. 21", "250 ms settling in contraction, for half the travel.",
         fmt::format("{:.0f} ms to 5 % of a step from 1 to 3 mm",
                     1e3 * contraction.to_five_percent.settling_s),
         holds_if(contraction.to_five_percent.settling_s <= 0.30), ""},
        {"fig. 21", "About 1 s settling in extension.",
         fmt::format("{:.2f} s to 5 % of a step from 3 to 1 mm", extension.to_five_percent.settling_s),
         holds_if(extension.to_five_percent.settling_s >= 0.5 && extension.to_five_percent.settling_s <= 1.2),
         ""},
        {"fig. 21, abstract", "Micro positioning to 5 um.",
         fmt::format("mean error at the end of {} steps at most {:.1f} um; {:.1f} um r.m.s. after the step "
                     "of half the travel",
                     made.size(), worst_error_um, um_per_mm * contraction.to_five_um.tail_rms),
         holds_if(worst_error_um <= 5.0), ""}};
    return chapter;
}

Chapter micro_bandwidth(const Laboratory& laboratory) {
    constexpr std::array frequencies_hz{0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.55, 0.75, 1.0};
    std::vector<SineResponse> sines(frequencies_hz.size());
    std::ranges::transform(frequencies_hz, sines.begin(),
                           [&](double frequency_hz) { return full_travel_sine(laboratory, frequency_hz); });
    report::XyCurve travel{"share of the travel that is covered", {}, {}},
        gain{"gain of the first harmonic", {}, {}};
    for (const SineResponse& sine : sines) {
        travel.x.push_back(sine.frequency_hz);
        travel.y.push_back(sine.travel_share);
        gain.x.push_back(sine.frequency_hz);
        gain.y.push_back(sine.gain);
    }
    constexpr std::size_t claimed = 4, beyond = 6;
    Chapter chapter{"bandwidth", "Bandwidth over the full travel", "", {}};
    chapter.html = chart_figure(
        "The closed loop on sines over the whole 4 mm. Up to about 0.3 Hz the platform still covers the "
        "travel; faster, the wire no "
        "longer cools in time: the platform stays contracted, and the lag grows.",
        report::xy_chart_svg("frequency, Hz", "share", {travel, gain}));
    chapter.claims = {
        {"micro stage", "About 0.25 Hz bandwidth at full travel.",
         fmt::format("at {:.2f} Hz {:.0f} % of the travel, {:.0f} deg behind; at {:.2f} Hz {:.0f} %, {:.0f} "
                     "deg behind",
                     sines[claimed].frequency_hz, 100.0 * sines[claimed].travel_share, sines[claimed].lag_deg,
                     sines[beyond].frequency_hz, 100.0 * sines[beyond].travel_share, sines[beyond].lag_deg),
         holds_if(sines[claimed].travel_share >= 0.98 && sines[claimed].lag_deg <= 10.0 &&
                  sines[beyond].travel_share <= 0.95 && sines[beyond].lag_deg >= 20.0),
         ""}};
    return chapter;
}

}  // namespace fidservo::reproduce
