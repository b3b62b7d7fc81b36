// SPDX-License-Identifier: GPL-3.0-or-later
// What the publication leaves for later: friction beside the dead zone, the carriage shaking the platform, a
// second thermal mass. Here as effects of the simulator (plant/effects), against the same run without them.
#include "core/rig.h"
#include "plant/effects/catalogue.h"
#include "src/files/recording/writer.h"
#include "src/reproduce/chapters.h"
#include "src/reproduce/figures.h"
#include "src/reproduce/step_response.h"
#include "src/simulation/simulate.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace fidservo::reproduce {

namespace {

/// A run of the simulator, nominal where no effect is named.
struct Variant {
    std::string label;
    std::string effect;  ///< as --effect takes it; empty: none
};

Recording run(const Laboratory& laboratory, const Experiment& experiment, const Variant& variant) {
    std::vector<plant::EffectSetting> effects;
    if (!variant.effect.empty()) effects.push_back(plant::parse_effect(variant.effect));
    const std::string name =
        experiment.kind + "-" + (effects.empty() ? "nominal" : std::string(effects.front().effect->name));
    Recording recording = simulate(laboratory.rig, effects, experiment, name, laboratory.seed);
    write_recording(laboratory.out / "recordings" / name, recording, laboratory.rig.camera);
    return recording;
}

constexpr const char* coulomb = "coulomb_friction:level_V=0.1";

/// A pulse, then nothing: what stops the carriage?
std::string coasting(const Laboratory& laboratory) {
    constexpr double start_mm = 20.0, pulse_V = 4.5, pulse_s = 0.25;
    const Experiment experiment{.kind = "coast",
                                .duration_s = 0.6,
                                .carriage_mm = start_mm,
                                .macro_V = steps({0.0, pulse_s}, {pulse_V, 0.0})};
    const std::array variants{Variant{"dead zone alone", ""}, Variant{"with Coulomb friction 0.1 V", coulomb},
                              Variant{"with Stribeck friction 0.2 V", "stribeck_friction"},
                              Variant{"with viscous friction", "viscous_friction"},
                              Variant{"with bristles (LuGre)", "presliding"}};
    const double count_mm = laboratory.rig.macro.encoder_resolution_mm;
    SignalPlot plot{"Carriage", "mm", {}};
    std::vector<std::vector<std::string>> rows;
    for (const Variant& variant : variants) {
        const std::vector<double> carriage =
            carriage_mm(laboratory.rig, run(laboratory, experiment, variant));
        const auto released = static_cast<std::size_t>(std::lround(pulse_s / laboratory.rig.tick_s));
        const auto last_move = std::adjacent_find(carriage.rbegin(), carriage.rend(), std::not_equal_to{});
        rows.push_back(
            {variant.label, fmt::format("{:.2f}", carriage[released] - start_mm),
             fmt::format("{:.2f}", carriage.back() - carriage[released]),
             fmt::format("{:.0f}", 1e3 * laboratory.rig.tick_s *
                                           static_cast<double>(std::distance(last_move, carriage.rend())) -
                                       1e3 * pulse_s)});
        plot.signals.push_back({variant.label, carriage, false, 2});
    }
    return time_figure("coast",
                       fmt::format("A pulse of {} V for {:.0f} ms, then nothing. The published dead zone "
                                   "acts at the input only: the "
                                   "carriage coasts. Friction on the motion brakes it.",
                                   pulse_V, 1e3 * pulse_s),
                       laboratory.rig.tick_s, {plot}) +
           table_html({"friction", "way under voltage, mm", "way after it, mm", "last count after, ms"},
                      rows) +
           fmt::format("<p class=\"caption\">By the encoder, to a count of {:.0f} um.</p>", 1e3 * count_mm);
}

/// Does the PD overshoot where friction brakes?
std::string overshoot_with_friction(const Laboratory& laboratory) {
    constexpr double from_mm = 60.0, band_counts = 1.5, tail_s = 0.3;
    constexpr std::array steps_mm{80.0, 40.0, 20.0, 10.0, 5.0};
    const double count_mm = laboratory.rig.macro.encoder_resolution_mm;
    std::vector<std::vector<std::string>> rows;
    for (const double step_mm : steps_mm) {
        const Experiment experiment{.kind = fmt::format("pd-{:.0f}mm", step_mm),
                                    .duration_s = 2.5,
                                    .carriage_mm = from_mm,
                                    .macro_setpoint_mm = [=](double) { return from_mm + step_mm; }};
        std::vector<std::string> row{fmt::format("{:.0f}", step_mm)};
        for (const Variant& variant : {Variant{"", ""}, Variant{"", coulomb}}) {
            const std::vector<double> carriage =
                carriage_mm(laboratory.rig, run(laboratory, experiment, variant));
            const StepResponse response = step_response(
                carriage, from_mm, from_mm + step_mm, band_counts * count_mm, tail_s, laboratory.rig.tick_s);
            row.push_back(fmt::format("{:.0f}", response.overshoot / count_mm));
            row.push_back(fmt::format("{:.1f}", response.final_error / count_mm));
        }
        rows.push_back(row);
    }
    return table_html(
        {"step under the nonlinear PD, mm", "overshoot, dead zone alone, counts", "error at the end, counts",
         "overshoot, with Coulomb friction, counts", "error at the end, counts"},
        rows);
}

/// What the platform does when the carriage starts and stops under it.
std::string shaken_platform(const Laboratory& laboratory) {
    const Experiment experiment{.kind = "shake",
                                .duration_s = 0.8,
                                .carriage_mm = 60.0,
                                .macro_V = steps({0.0, 0.1, 0.3}, {0.0, 4.5, 0.0}),
                                .micro_V = [](double) { return 0.0; }};
    SignalPlot plot{"Platform by the Hall sensor", "mm", {}};
    std::vector<double> swings_um;
    for (const Variant& variant :
         {Variant{"rigid", ""}, Variant{"flexure shaken by the carriage", "macro_coupling"}}) {
        std::vector<double> platform = platform_mm(laboratory.rig, run(laboratory, experiment, variant));
        const auto [low, high] = std::ranges::minmax(platform);
        swings_um.push_back(1e3 * (high - low));
        plot.signals.push_back({variant.label, std::move(platform), false, 4});
    }
    return time_figure("shake",
                       fmt::format("The carriage starts and stops; the platform should not care. Peak to "
                                   "peak {:.0f} um (the sensor's "
                                   "noise) without coupling, {:.0f} um with it.",
                                   swings_um[0], swings_um[1]),
                       laboratory.rig.tick_s, {plot});
}

/// Cooling, with and without a mount that has stored heat.
std::string slow_cooling(const Laboratory& laboratory) {
    const Experiment experiment{
        .kind = "cool", .duration_s = 14.0, .carriage_mm = 60.0, .micro_V = steps({0.0, 5.0}, {1.66, 0.0})};
    SignalPlot plot{"Platform by the Hall sensor", "mm", {}};
    for (const Variant& variant :
         {Variant{"one thermal mass", ""}, Variant{"with a second thermal mass", "second_thermal_mass"}})
        plot.signals.push_back(
            {variant.label, platform_mm(laboratory.rig, run(laboratory, experiment, variant)), false, 3});
    return time_figure("cool",
                       "Heated for 5 s, then left to cool. Plates and mount store heat and give it back: the "
                       "platform extends later.",
                       laboratory.rig.tick_s, {plot});
}

}  // namespace

Chapter beyond_model(const Laboratory& laboratory) {
    return {"beyond",
            "What the publication leaves for later",
            "<h3>Friction beside the dead zone</h3>" + coasting(laboratory) +
                overshoot_with_friction(laboratory) + "<h3>Stage coupling</h3>" +
                shaken_platform(laboratory) + "<h3>A second thermal mass</h3>" + slow_cooling(laboratory),
            {}};
}

}  // namespace fidservo::reproduce
