// SPDX-License-Identifier: GPL-3.0-or-later
// The nonlinear PD on a decaying square wave (fig. 18, 19), and both readings of eq. 9.
#include "core/rig.h"
#include "src/reproduce/chapters.h"
#include "src/reproduce/figures.h"
#include "src/reproduce/step_response.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace fidservo::reproduce {

namespace {

constexpr double middle_mm = 100.0, period_s = 2.5;
constexpr int setpoints = 9;

/// Set points to both sides of the middle, each nearer than the last.
Course decaying_square_wave() {
    constexpr double first_mm = 40.0, decay = 0.7;
    std::vector<double> times_s, places_mm;
    double distance_mm = first_mm;
    for (int i = 0; i < setpoints; ++i, distance_mm *= -decay) {
        times_s.push_back(i * period_s);
        places_mm.push_back(middle_mm + distance_mm);
    }
    return steps(std::move(times_s), std::move(places_mm));
}

std::vector<StepResponse> pd_responses(const Rig& rig, const Recording& recording,
                                       const std::vector<double>& carriage) {
    constexpr double tail_s = 0.3;
    const double count_mm = rig.macro.encoder_resolution_mm;
    std::vector<StepResponse> found;
    double from_mm = middle_mm;
    for (const HeldSetpoint& held : held_setpoints(column(recording, &StageRow::macro_setpoint_mm))) {
        const double to_mm = count_mm * std::floor(held.value / count_mm + 0.5);
        found.push_back(step_response(std::span(carriage).subspan(held.begin, held.end - held.begin), from_mm,
                                      to_mm, 1.5 * count_mm, tail_s, rig.tick_s));
        from_mm = to_mm;
    }
    return found;
}

std::string pd_response_table(const std::vector<StepResponse>& steps_made, double count_mm) {
    std::vector<std::vector<std::string>> rows;
    rows.reserve(steps_made.size());
    for (const StepResponse& step : steps_made)
        rows.push_back({fmt::format("{:.2f} to {:.2f}", step.from, step.to),
                        fmt::format("{:.2f}", step.settling_s),
                        fmt::format("{:.0f}", step.overshoot / count_mm),
                        fmt::format("{:.1f}", step.final_error / count_mm)});
    return table_html(
        {"step, mm", "within one count after, s", "overshoot, counts", "error at the end, counts"}, rows);
}

double largest(const std::vector<StepResponse>& steps_made, double StepResponse::*member) {
    double value = 0.0;
    for (const StepResponse& step : steps_made) value = std::max(value, std::abs(step.*member));
    return value;
}

/// A step of 50 mm with the sign of eq. 9 as printed, and as meant.
Claim both_readings(const Laboratory& laboratory, Chapter& chapter) {
    constexpr double from_mm = 50.0, to_mm = 100.0, duration_s = 3.0;
    const Experiment step{
        .kind = "step", .duration_s = duration_s, .carriage_mm = from_mm, .macro_setpoint_mm = [](double) {
            return to_mm;
        }};
    Laboratory printed = laboratory;
    printed.rig.macro.pd->e1_V_per_count = std::abs(printed.rig.macro.pd->e1_V_per_count);
    const Rig& rig = laboratory.rig;
    const Recording meant_run = perform(laboratory, "eq9-minus", step),
                    printed_run = perform(printed, "eq9-plus", step);
    const std::vector<double> meant = carriage_mm(rig, meant_run), plus = carriage_mm(rig, printed_run);
    const double count_mm = rig.macro.encoder_resolution_mm;
    const StepResponse good = step_response(meant, from_mm, to_mm, 1.5 * count_mm, 0.5, rig.tick_s),
                       bad = step_response(plus, from_mm, to_mm, 1.5 * count_mm, 0.5, rig.tick_s);
    chapter.html += time_figure(
        "eq9",
        "Both readings of eq. 9 on a step of 50 mm. With the plus sign that is printed the loop overshoots "
        "and does not "
        "come to rest; with a minus sign it is a PD controller and does what the publication describes.",
        rig.tick_s,
        {{"Carriage",
          "mm",
          {{"set point", column(meant_run, &StageRow::macro_setpoint_mm), true, 2, true},
           {"minus sign", meant, false, 2},
           {"plus sign, as printed", plus, false, 2}}}});
    return {"eq. 9",
            "The control law settles without overshoot. (The sign printed in eq. 9 cannot be meant.)",
            fmt::format("minus: overshoot {:.2f} mm, {:.2f} mm from peak to peak at the end; plus: overshoot "
                        "{:.1f} mm, {:.1f} mm "
                        "from peak to peak at the end",
                        good.overshoot, good.tail_peak_to_peak, bad.overshoot, bad.tail_peak_to_peak),
            holds_if(good.tail_peak_to_peak <= count_mm && good.overshoot <= 2.0 * count_mm + 1e-9 &&
                     bad.overshoot > 1.0 && bad.tail_peak_to_peak > count_mm),
            ""};
}

}  // namespace

Chapter nonlinear_pd(const Laboratory& laboratory) {
    const Rig& rig = laboratory.rig;
    const double count_mm = rig.macro.encoder_resolution_mm;
    const Recording recording = perform(laboratory, "pd-square",
                                        {.kind = "pd-square",
                                         .duration_s = setpoints * period_s,
                                         .carriage_mm = middle_mm,
                                         .macro_setpoint_mm = decaying_square_wave()});
    const std::vector<double> carriage = carriage_mm(rig, recording);
    std::vector<double> error = column(recording, &StageRow::macro_setpoint_mm);
    std::ranges::transform(error, carriage, error.begin(), std::minus{});

    Chapter chapter{"pd", "The nonlinear PD: decaying square wave", "", {}};
    chapter.html = time_figure(
        "pd-square",
        "Fig. 18 and 19 from our data: the carriage follows set points that come nearer to the middle from "
        "step to step, and "
        "stops on each. The command jumps over the dead zone whenever there is an error, and is zero when "
        "there is none.",
        rig.tick_s,
        {{"Carriage",
          "mm",
          {{"set point", column(recording, &StageRow::macro_setpoint_mm), true, 2, true},
           {"carriage (encoder)", carriage, false, 2}}},
         {"Error", "mm", {{"set point - carriage", error, false, 2}}, 160},
         {"Motor command", "V", {{"motor", column(recording, &StageRow::macro_command_V), true}}, 160}});
    const std::vector<StepResponse> steps_made = pd_responses(rig, recording, carriage);
    chapter.html += pd_response_table(steps_made, count_mm);
    const double overshoot_mm = largest(steps_made, &StepResponse::overshoot);
    const double error_mm = largest(steps_made, &StepResponse::final_error);
    chapter.claims = {
        {"fig. 18", "The nonlinear PD does not overshoot.",
         fmt::format("at most {:.0f} counts of 50 um in {} steps", overshoot_mm / count_mm, setpoints),
         overshoot_mm <= 0.0                     ? Outcome::holds
         : overshoot_mm <= 2.0 * count_mm + 1e-9 ? Outcome::rig_differs
                                                 : Outcome::fails,
         "The rig coasts without braking friction: its dead zone acts at the input, so a carriage that is "
         "let go with speed runs on by "
         "up to two counts."},
        {"fig. 19", "Zero steady-state error.",
         fmt::format("largest error at the end of a step: {:.1f} counts", error_mm / count_mm),
         holds_if(error_mm < 0.5 * count_mm), ""},
        {"abstract", "Macro positioning to 50 um.",
         fmt::format("largest distance from the set point at the end of a step: {:.0f} um", 1e3 * error_mm),
         holds_if(error_mm <= count_mm), ""},
        both_readings(laboratory, chapter)};
    return chapter;
}

}  // namespace fidservo::reproduce
