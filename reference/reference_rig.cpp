// SPDX-License-Identifier: GPL-3.0-or-later
#include "reference/reference_rig.h"

#include "core/demand.h"
#include "core/rig.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fidservo::reference {

namespace {

constexpr double probe_s = 1e-5;  ///< over which the camera's speed is taken

/// Simulates the first `way_s` seconds of a tick in sub-steps of equal length while a command is held. Calls
/// step(command in V, sub-step's length in s) for each.
template <class Step>
void run(const RigModel& model, const std::array<HeldCommand, 2>& commands, double way_s, const Step& step) {
    const double longest_s = model.tick_s / model.substeps;
    for (const HeldCommand& held : commands) {
        const double length_s = std::min(held.length_s, way_s);
        way_s -= length_s;
        if (length_s <= 0.0) continue;
        constexpr double whole = 1e-9;  // of a sub-step: rounding does not add another
        const int steps = std::max(1, static_cast<int>(std::ceil(length_s / longest_s - whole)));
        for (int i = 0; i < steps; ++i) step(held.volts, length_s / steps);
    }
}

/// The part of a tick from its beginning on.
void move(const RigModel& model, State& state, double macro_V, double micro_V, double way_s) {
    const auto motor = command(state.macro_commands, model.departures.drive.delay_s, model.tick_s, macro_V);
    const double time_s = static_cast<double>(state.tick) * model.tick_s;
    const double left = 1.0 - model.departures.drive.fading_per_s * time_s;
    run(model, motor, way_s,
        [&](double volts, double h_s) { advance(model.carriage, state.carriage, left * volts, h_s); });
    state.macro_V = macro_V;
    const double filter_s = model.departures.hall.crosstalk_filter_s;
    const double passed = filter_s > 0.0 ? 1.0 - std::exp(-way_s / filter_s) : 1.0;
    state.leaked_V += passed * (macro_V - state.leaked_V);
    if (!model.platform) return;
    const PlatformModel& platform = *model.platform;
    PlatformState& there = *state.platform;
    const auto heater = command(there.commands, model.departures.heater.delay_s, model.tick_s, micro_V);
    run(model, heater, way_s, [&](double volts, double h_s) {
        advance(platform.wire, there.wire_degC, volts, h_s);
        move_to(platform.hysteresis, there.hysteresis, there.wire_degC[0]);
    });
}

/// What a smooth discrepancy adds to a reading or to the camera's place.
double smooth_shift(const RigModel& model, const State& state, const Truth& there, ActsOn acts_on) {
    const Discrepancy& discrepancy = model.departures.discrepancy;
    if (discrepancy.function.size == 0.0 || discrepancy.acts_on != acts_on) return 0.0;
    const auto variable = [&] {
        switch (discrepancy.depends_on) {
            case DependsOn::carriage_speed:
                return there.carriage_mm_per_s;
            case DependsOn::carriage_place:
                return there.carriage_mm;
            case DependsOn::contraction:
                return there.platform_mm;
            case DependsOn::wire_temperature:
                return there.wire_degC - model.platform->nominal_room_degC;
            case DependsOn::time:
                break;
        }
        return static_cast<double>(state.tick) * model.tick_s;
    };
    return discrepancy.function(variable());
}

double camera_position_mm(const RigModel& model, const State& state) {
    const Truth there = truth(model, state);
    return there.carriage_mm + there.platform_mm + smooth_shift(model, state, there, ActsOn::camera_place);
}

}  // namespace

RigModel make_rig_model(const Rig& rig, const Departures& departures, int substeps) {
    FIDSERVO_DEMAND(substeps >= 1);
    RigModel model;
    model.tick_s = rig.tick_s;
    model.substeps = substeps;
    model.encoder_resolution_mm = rig.macro.encoder_resolution_mm;
    model.departures = departures;
    model.carriage = make_carriage(rig, departures);
    if (rig.micro)
        model.platform = PlatformModel{make_wire(rig.micro->heater, departures.heater),
                                       make_hysteresis(*rig.micro->fod, departures.hysteresis),
                                       rig.micro->hall, rig.micro->heater.ambient_degC};
    if (rig.camera && rig.fiducials)
        model.camera = CameraModel{*rig.camera, *rig.fiducials, departures.camera};
    return model;
}

State start(const RigModel& model, double carriage_mm, std::uint64_t seed) {
    State state;
    state.carriage.position_mm = carriage_mm;
    state.macro_commands = idle_line(model.departures.drive.delay_s, model.tick_s);
    if (model.platform) {
        const WireState wire_degC = cold_wire(model.platform->wire);
        state.platform = PlatformState{wire_degC, heated_to(model.platform->hysteresis, wire_degC[0]),
                                       idle_line(model.departures.heater.delay_s, model.tick_s),
                                       NoiseStream(seed, "reference/hall")};
    }
    if (model.camera) state.camera = CameraState{0, NoiseStream(seed, "reference/corners")};
    return state;
}

Reading sample(const RigModel& model, State& state) {
    Reading reading;
    reading.encoder_count =
        encoder_count(model.encoder_resolution_mm, model.departures.encoder, state.carriage.position_mm);
    if (model.platform) {
        const Truth there = truth(model, state);
        const HallInput input{there.platform_mm, state.leaked_V,
                              static_cast<double>(state.tick) * model.tick_s,
                              state.platform->wire_degC[0] - model.platform->nominal_room_degC};
        const HallParameters& hall = model.platform->hall;
        const double volts = hall_volts(hall, model.departures.hall, input) +
                             smooth_shift(model, state, there, ActsOn::hall_reading);
        reading.hall_adc = hall_reading(hall, volts, state.platform->noise);
    }
    return reading;
}

void look(const RigModel& model, State& state, double macro_V, double micro_V,
          std::vector<TagDetection>& detections) {
    if (!model.camera) return;
    const double tick_start_s = static_cast<double>(state.tick) * model.tick_s;
    for (; exposure_s(*model.camera, state.camera->next_frame) < tick_start_s + model.tick_s;
         ++state.camera->next_frame) {
        const double way_s = exposure_s(*model.camera, state.camera->next_frame) - tick_start_s;
        const auto position_mm = [&](double time_s) {
            State there = state;
            move(model, there, macro_V, micro_V, time_s);
            return camera_position_mm(model, there);
        };
        const double from_s = std::min(way_s, model.tick_s - probe_s);
        const double speed_mm_per_s = (position_mm(from_s + probe_s) - position_mm(from_s)) / probe_s;
        const double s_mm = position_mm(way_s);
        if (auto seen = see(*model.camera, s_mm, speed_mm_per_s, state.camera->noise)) {
            seen->time_ns = stamp_ns(*model.camera, state.camera->next_frame);
            detections.push_back(*seen);
        }
    }
}

void advance(const RigModel& model, State& state, double macro_V, double micro_V) {
    move(model, state, macro_V, micro_V, model.tick_s);
    ++state.tick;
}

Truth truth(const RigModel& model, const State& state) {
    Truth result{state.carriage.position_mm, state.carriage.speed_mm_per_s, 0.0, 0.0};
    if (model.platform) {
        result.wire_degC = state.platform->wire_degC[0];
        result.platform_mm =
            contraction_mm(model.platform->hysteresis, state.platform->hysteresis) + state.carriage.swing_mm;
    }
    return result;
}

}  // namespace fidservo::reference
