// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/record/foresight.h"

#include "core/micro_model.h"
#include "core/rig.h"
#include "src/record/travel_watch.h"
#include "src/simulation/simulate.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace fidservo {

namespace {

Recording foreseen(const Rig& rig, const Experiment& experiment) {
    Rig blind = rig;
    blind.fiducials.reset();  // the camera stays: the file may state effects of it
    return simulate(blind, {}, experiment, experiment.kind, 0);
}

std::optional<std::string> end_of_travel(const Rig& rig, const Experiment& experiment,
                                         const Recording& recording) {
    const TravelWatch watch = travel_watch(rig);
    TravelWatchState state;
    for (const StageRow& row : recording.rows) {
        const double carriage_mm = row.encoder_count * rig.macro.encoder_resolution_mm;
        if (leaves_travel(watch, state, carriage_mm))
            return fmt::format(
                "from {:.1f} mm the carriage would leave its travel, {:.0f} to {:.0f} mm, after {:.1f} s",
                experiment.carriage_mm, rig.macro.low_mm, rig.macro.high_mm, seconds(row.time_ns));
    }
    return std::nullopt;
}

std::optional<std::string> overheating(const Rig& rig, const Recording& recording, double limit_degC) {
    const HeaterParameters& heater = rig.micro->heater;
    double wire_degC = heater.ambient_degC, hottest_degC = wire_degC;
    for (const StageRow& row : recording.rows) {
        wire_degC = heater_step_degC(heater, wire_degC, row.micro_command_V, rig.tick_s);
        hottest_degC = std::max(hottest_degC, wire_degC);
    }
    if (hottest_degC <= limit_degC) return std::nullopt;
    return fmt::format("the wire would be at {:.0f} degC; allowed: {:.0f} (stage.watchdog.wire_limit_degC)",
                       hottest_degC, limit_degC);
}

}  // namespace

std::optional<std::string> why_not(const Rig& rig, const Experiment& experiment,
                                   std::optional<double> wire_limit_degC) {
    return why_not(rig, experiment, foreseen(rig, experiment), wire_limit_degC);
}

std::optional<std::string> why_not(const Rig& rig, const Experiment& experiment, const Recording& recording,
                                   std::optional<double> wire_limit_degC) {
    if (auto beyond = end_of_travel(rig, experiment, recording)) return beyond;
    if (!rig.micro || !wire_limit_degC) return std::nullopt;
    return overheating(rig, recording, *wire_limit_degC);
}

DrawnExperiment draw_for(const Rig& rig, std::string_view kind, std::uint64_t seed,
                         std::string_view recording_name, std::optional<double> wire_limit_degC) {
    constexpr int more_draws = 7;
    DrawnExperiment first{make_experiment(kind, rig, seed, recording_name), {}};
    first.why_not = why_not(rig, first.experiment, wire_limit_degC);
    if (!first.why_not) return first;
    for (int k = 1; k <= more_draws; ++k) {
        Experiment next = make_experiment(kind, rig, seed, fmt::format("{}/{}", recording_name, k));
        if (!why_not(rig, next, wire_limit_degC)) return {std::move(next), {}};
    }
    return first;
}

}  // namespace fidservo
