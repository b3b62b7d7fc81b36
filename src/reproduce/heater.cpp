// SPDX-License-Identifier: GPL-3.0-or-later
// The heater: temperature inferred from position through the inverse hysteresis, then static gain, heating
// and cooling (fig. 13 to 16).
#include "calib/wire/heater_fit.h"
#include "core/input_error.h"
#include "core/random.h"
#include "core/rig.h"
#include "src/reproduce/chapters.h"
#include "src/reproduce/figures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include <fmt/format.h>

namespace fidservo::reproduce {

namespace {

constexpr std::array levels_V{1.5, 1.6, 1.7, 1.8};
constexpr double heater_on_s = 5.0, heater_run_s = 12.0;

calib::HeaterRun run_of(const Recording& recording) {
    return {.tick_s = recording.tick_s,
            .command = column(recording, &StageRow::micro_command_V),
            .reading = column(recording, &StageRow::hall_adc)};
}

/// Inferred temperature in degC; not finite where the platform stands at an end of its travel, which tells
/// nothing of it.
std::vector<double> inferred_degC(const MicroModel& model, const calib::HeaterRun& run) {
    constexpr double least_lsb_per_degC = 20.0;
    calib::InferredTemperature inferred = calib::infer_temperature(model, run.reading);
    for (std::size_t k = 0; k < inferred.temp_degC.size(); ++k)
        if (inferred.sensitivity_lsb_per_degC[k] < least_lsb_per_degC)
            inferred.temp_degC[k] = std::numeric_limits<double>::quiet_NaN();
    return std::move(inferred.temp_degC);
}

/// What somebody would guess before the identification: far off.
MicroModel guessed_model(const MicroParameters& micro) {
    MicroModel model = nominal_micro_model(micro);
    model.heater.gain_degC_per_V *= 0.8;
    model.heater.onset_V -= 0.05;
    model.heater.heating_tau_s *= 1.3;
    model.heater.cooling_tau_s *= 0.75;
    return model;
}

struct ControlSteps {
    std::vector<Recording> recordings;
    std::vector<calib::HeaterRun> runs;
};

ControlSteps make_control_steps(const Laboratory& laboratory) {
    ControlSteps made;
    for (const double level_V : levels_V) {
        const std::string name = fmt::format("ctrl-{:.1f}V", level_V);
        made.recordings.push_back(perform(laboratory, name,
                                          {.kind = name,
                                           .duration_s = heater_run_s,
                                           .carriage_mm = 100.0,
                                           .micro_V = steps({0.0, heater_on_s}, {level_V, 0.0})}));
        made.runs.push_back(run_of(made.recordings.back()));
    }
    return made;
}

/// A staircase of commands that the fit has not seen.
Recording validation_run(const Laboratory& laboratory) {
    constexpr double step_s = 1.5;
    constexpr int steps_made = 16;
    NoiseStream draw(laboratory.seed, "reproduce/heater");
    std::vector<double> times_s, volts;
    for (int i = 0; i < steps_made; ++i) {
        times_s.push_back(i * step_s);
        volts.push_back(i % 4 == 3 ? 0.0 : 1.38 + 0.3 * draw.uniform());
    }
    return perform(laboratory, "heater-validation",
                   {.kind = "heater-validation",
                    .duration_s = steps_made * step_s,
                    .carriage_mm = 100.0,
                    .micro_V = steps(times_s, volts)});
}

double rms_where_both(const std::vector<double>& a, const std::vector<double>& b) {
    double squares = 0.0, count = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) {
        if (!std::isfinite(a[k] - b[k])) continue;
        squares += (a[k] - b[k]) * (a[k] - b[k]);
        count += 1.0;
    }
    return count > 0.0 ? std::sqrt(squares / count) : std::numeric_limits<double>::infinity();
}

/// Seconds from the command's end until the platform is fully extended, to the system's accuracy.
double extension_s(const Rig& rig, const Recording& recording) {
    constexpr double accuracy_mm = 0.005;
    const std::vector<double> platform = platform_mm(rig, recording);
    const auto last =
        std::find_if(platform.rbegin(), platform.rend(), [&](double at) { return at > accuracy_mm; });
    return rig.tick_s * static_cast<double>(platform.rend() - last) - heater_on_s;
}

/// How alike the cooling curves after different heating levels are.
struct CoolingCurves {
    double spread_degC;  ///< largest difference, once they are moved in time to pass a common temperature
                         ///< together
    double delay_s;      ///< by which the last one passes it after the first
};

CoolingCurves cooling_curves(const MicroModel& model, const ControlSteps& made, double tick_s) {
    constexpr double common_degC = 55.0, compared_s = 0.3;
    const auto off = static_cast<std::ptrdiff_t>(std::lround(heater_on_s / tick_s));
    const auto compared = static_cast<std::ptrdiff_t>(std::lround(compared_s / tick_s));
    std::vector<std::vector<double>> curves;
    std::vector<double> passes_s;
    for (const calib::HeaterRun& run : made.runs) {
        const std::vector<double> temp_degC = inferred_degC(model, run);
        const auto passes =
            std::find_if(temp_degC.begin() + off, temp_degC.end(), [](double t) { return t < common_degC; });
        if (temp_degC.end() - passes < compared) continue;
        curves.emplace_back(passes, passes + compared);
        passes_s.push_back(tick_s * static_cast<double>(passes - temp_degC.begin()) - heater_on_s);
    }
    if (curves.size() < 2) throw RunFault("cooling curves: the platform does not show them");
    CoolingCurves alike{0.0, std::ranges::max(passes_s) - std::ranges::min(passes_s)};
    for (std::size_t k = 0; k < curves.front().size(); ++k)
        for (const auto& curve : curves)
            if (std::isfinite(curve[k] - curves.front()[k]))
                alike.spread_degC = std::max(alike.spread_degC, std::abs(curve[k] - curves.front()[k]));
    return alike;
}

SignalPlot plot_of(const char* title, const char* unit, const ControlSteps& made,
                   const std::function<std::vector<double>(std::size_t)>& signal, int digits) {
    SignalPlot plot{title, unit, {}};
    for (std::size_t i = 0; i < made.runs.size(); ++i)
        plot.signals.push_back({fmt::format("CTRL {:.1f} V", levels_V[i]), signal(i), false, digits});
    return plot;
}

}  // namespace

Chapter heater(const Laboratory& laboratory) {
    const Rig& rig = laboratory.rig;
    const HeaterParameters& truth = rig.micro->heater;
    const ControlSteps made = make_control_steps(laboratory);
    const auto fit = calib::fit_heater(guessed_model(*rig.micro), made.runs);
    if (!fit) throw RunFault(fmt::format("identification of the heater: {}", fit.error().text));
    MicroModel model = nominal_micro_model(*rig.micro);
    model.heater = fit->heater;

    const Recording unseen = validation_run(laboratory);
    const calib::HeaterRun unseen_run = run_of(unseen);
    const std::vector<double> inferred = inferred_degC(model, unseen_run);
    const std::vector<double> predicted = calib::predict_temperature(model.heater, unseen_run);
    const double validation_degC = rms_where_both(inferred, predicted);
    const double hall_lsb =
        rms_where_both(calib::predict_hall(model, model.heater, unseen_run), unseen_run.reading);
    const CoolingCurves cooling = cooling_curves(model, made, rig.tick_s);
    const double full_extension_s = extension_s(rig, made.recordings.back());

    Chapter chapter{"heater", "The heater", "", {}};
    chapter.html =
        time_figure("ctrl-steps",
                    "Fig. 13 and 14 from our data: steps of the heater command for 5 s, then cooling. The "
                    "temperature is inferred from "
                    "the position; it has gaps where the platform stands at an end of its travel, which says "
                    "nothing of it.",
                    rig.tick_s,
                    {plot_of(
                         "Platform by the Hall sensor", "mm", made,
                         [&](std::size_t i) { return platform_mm(rig, made.recordings[i]); }, 3),
                     plot_of(
                         "Inferred temperature", "degC", made,
                         [&](std::size_t i) { return inferred_degC(model, made.runs[i]); }, 1)}) +
        time_figure("heater-validation",
                    "Fig. 15 and 16 from our data: the heater model on commands that it was not fitted to, "
                    "against the temperature inferred from the position. Where the platform stands after a "
                    "turn the inference keeps its last value: the position does not tell.",
                    rig.tick_s,
                    {{"Temperature",
                      "degC",
                      {{"inferred", inferred, false, 1}, {"heater model", predicted, false, 1}}},
                     {"Heater command", "V", {{"heater", unseen_run.command, true}}, 140}}) +
        table_html({"identified", "value", "standard error", "rig"},
                   {{"onset, V", fmt::format("{:.5f}", fit->heater.onset_V),
                     fmt::format("{:.5f}", fit->std[0]), fmt::format("{:.2f}", truth.onset_V)},
                    {"gain, degC/V", fmt::format("{:.3f}", fit->heater.gain_degC_per_V),
                     fmt::format("{:.3f}", fit->std[1]), fmt::format("{:.0f}", truth.gain_degC_per_V)},
                    {"heating time constant, s", fmt::format("{:.5f}", fit->heater.heating_tau_s),
                     fmt::format("{:.5f}", fit->std[2]), fmt::format("{:.2f}", truth.heating_tau_s)},
                    {"cooling time constant, s", fmt::format("{:.5f}", fit->heater.cooling_tau_s),
                     fmt::format("{:.5f}", fit->std[3]), fmt::format("{:.2f}", truth.cooling_tau_s)},
                    {"room, degC", fmt::format("{:.3f}", fit->heater.ambient_degC),
                     fmt::format("{:.3f}", fit->std[4]), fmt::format("{:.0f}", truth.ambient_degC)}});
    chapter.claims = {
        {"fig. 13", "No effect below a command of 1.3 V; above, the temperature rises in proportion.",
         fmt::format("onset {:.3f} V, {:.1f} degC/V", fit->heater.onset_V, fit->heater.gain_degC_per_V),
         holds_if(std::abs(fit->heater.onset_V - truth.onset_V) < 0.01 &&
                  std::abs(fit->heater.gain_degC_per_V / truth.gain_degC_per_V - 1.0) < 0.02),
         ""},
        {"fig. 14", "Cooling time constant 1 s.", fmt::format("{:.3f} s", fit->heater.cooling_tau_s),
         holds_if(std::abs(fit->heater.cooling_tau_s - 1.0) < 0.05), ""},
        {"fig. 14", "Equal cooling curves, whatever the heating level was.",
         fmt::format("equal to {:.1f} degC in shape; after higher levels they come up to {:.2f} s later",
                     cooling.spread_degC, cooling.delay_s),
         cooling.spread_degC < 2.0 ? Outcome::rig_differs : Outcome::fails,
         "The reference rig's wire heats on in proportion to the command beyond full contraction, and has "
         "first to cool through that; "
         "from there on its single time constant makes all curves one."},
        {"fig. 14", "About 4 s for full extension.",
         fmt::format("{:.1f} s from the end of CTRL {:.1f} V to within 5 um", full_extension_s,
                     levels_V.back()),
         full_extension_s > 2.0 && full_extension_s < 6.0 ? Outcome::rig_differs : Outcome::fails,
         "The reference rig cools with 1 s at every temperature: after three time constants its wire is "
         "below the foot of the "
         "hysteresis. A wire that hands its heat to a mount takes longer at the end (see the second thermal "
         "mass below)."},
        {"fig. 15, 16", "The heater model predicts the temperature on other commands.",
         fmt::format(
             "{:.2f} degC r.m.s. against the inferred temperature; {:.2f} LSB r.m.s. of the Hall reading",
             validation_degC, hall_lsb),
         holds_if(validation_degC < 3.0 && hall_lsb < 1.0), ""}};
    return chapter;
}

}  // namespace fidservo::reproduce
