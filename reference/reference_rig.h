// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// An independent model of a rig, for checking identification and diagnosis. It shares no formula with plant/:
// forces in balance, time continuous and integrated by Runge-Kutta in sub-steps, events located in time,
// hysteresis by areas of the Preisach plane.
//
//     const RigModel model = make_rig_model(rig);
//     State state = start(model, 100.0, seed);
//     for (;;) {
//         const Reading reading = sample(model, state);
//         look(model, state, macro_V, micro_V, detections);     // where the rig has a camera
//         advance(model, state, macro_V, micro_V);
//     }
#include "core/recording.h"
#include "reference/camera_view.h"
#include "reference/carriage.h"
#include "reference/delay_line.h"
#include "reference/departures.h"
#include "reference/hysteresis.h"
#include "reference/sensors.h"
#include "reference/wire_temperature.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace fidservo {
struct Rig;
}

namespace fidservo::reference {

inline constexpr int default_substeps = 20;

struct PlatformModel {
    WireModel wire;
    HysteresisModel hysteresis;
    HallParameters hall;
    double nominal_room_degC = 0.0;
};

/// The rig ready to tick. Parts that it does not have are empty. Immutable.
struct RigModel {
    double tick_s = 0.0;
    int substeps = default_substeps;  ///< integration steps per tick
    double encoder_resolution_mm = 0.0;
    Departures departures = {};
    CarriageModel carriage = {};
    std::optional<PlatformModel> platform = {};
    std::optional<CameraModel> camera = {};
};

struct PlatformState {
    WireState wire_degC;
    HysteresisState hysteresis;
    DelayLine commands;
    NoiseStream noise;
};

struct CameraState {
    std::int64_t next_frame = 0;
    NoiseStream noise;
};

/// All that changes in a run. A plain value: a copy is a snapshot.
struct State {
    std::int64_t tick = 0;
    double macro_V = 0.0;   ///< the motor command in force
    double leaked_V = 0.0;  ///< the motor command as filtered on its way to the Hall sensor's voltage
    CarriageState carriage = {};
    DelayLine macro_commands = {};
    std::optional<PlatformState> platform = {};
    std::optional<CameraState> camera = {};
};

struct Reading {
    std::int64_t encoder_count = 0;
    int hall_adc = 0;  ///< 0 without a micro stage
};

/// True values that no sensor shows.
struct Truth {
    double carriage_mm;
    double carriage_mm_per_s;
    double wire_degC;    ///< 0 without a micro stage
    double platform_mm;  ///< 0 without a micro stage
};

/// @param substeps  integration steps per tick, >= 1
RigModel make_rig_model(const Rig& rig, const Departures& departures = {}, int substeps = default_substeps);

/// A rig at rest with a cold wire; the encoder counts from the lower end of travel.
State start(const RigModel& model, double carriage_mm, std::uint64_t seed);

/// Samples the sensors. Of the state only the Hall sensor's noise stream changes.
Reading sample(const RigModel& model, State& state);

/// The camera's frames of the tick that begins, under the commands given: the detections are appended to
/// `detections`. Of the state only the camera's part changes.
void look(const RigModel& model, State& state, double macro_V, double micro_V,
          std::vector<TagDetection>& detections);

/// One tick under held commands in V.
void advance(const RigModel& model, State& state, double macro_V, double micro_V);

Truth truth(const RigModel& model, const State& state);

}  // namespace fidservo::reference
