// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The rig as physics, without images: two voltages in, two readings out, tick by tick.
//
// In each tick the sensors are sampled first; then the commands are held until the next tick:
//
//     const StagePlant plant = make_stage_plant(rig);
//     StageState state = start(plant, 100.0, seed);
//     for (;;) {
//         const StageReading reading = sample(plant, state);
//         advance(plant, state, macro_V, micro_V);
//     }
//
// The state is the ground truth. Only the simulator and tests see it; what runs on the rig sees readings
// only.
#include "plant/camera.h"
#include "plant/encoder.h"
#include "plant/macro_axis.h"
#include "plant/micro_stage.h"

#include <cstdint>
#include <optional>

namespace fidservo {
struct Rig;
}

namespace fidservo::plant {

/// The parameters of the physics, which effects change. Parts that the rig does not have are empty.
struct PlantParameters {
    double tick_s = 0.0;                        ///< T
    MacroAxisParameters axis;                   ///< the macro stage
    Encoder encoder{};                          ///< the carriage's encoder
    std::optional<MicroStageParameters> micro;  ///< the platform, its wire and its sensor
    std::optional<CameraDeviation> camera;      ///< how the camera deviates from what the file says
};

/// The rig as its file describes it, ready to tick. Immutable.
struct StagePlant {
    double tick_s = 0.0;                    ///< T
    MacroAxis axis;                         ///< the macro stage
    Encoder encoder{};                      ///< the carriage's encoder
    std::optional<MicroStage> micro;        ///< the platform, its wire and its sensor
    std::optional<CameraDeviation> camera;  ///< how the camera deviates from what the file says
};

/// All that changes in a run. A plain value: a copy is a snapshot.
struct StageState {
    MacroAxisState axis;                   ///< state of the carriage
    EncoderState encoder;                  ///< the encoder's zero
    std::optional<MicroStageState> micro;  ///< state of the platform and its wire
};

/// What the board samples at a tick. Without a micro stage hall_adc is 0.
struct StageReading {
    std::int64_t encoder_count = 0;  ///< counts since power came on
    int hall_adc = 0;                ///< of the platform's sensor, LSB
};

/// The parameters of a rig as its file describes it, with the effects that the file states.
PlantParameters plant_parameters(const Rig& rig);

/// A plant with these parameters, ready to tick.
StagePlant make_stage_plant(const PlantParameters& parameters);
/// The rig as its file describes it, ready to tick.
StagePlant make_stage_plant(const Rig& rig);

/// A rig at rest with a cold wire; the carriage stands at a position within the travel, in mm.
StageState start(const StagePlant& plant, double carriage_mm, std::uint64_t seed,
                 EncoderOrigin origin = EncoderOrigin::power_up);

/// Samples the sensors. Of the state only the sensors' noise streams change.
StageReading sample(const StagePlant& plant, StageState& state);

/// One tick under held commands in V. Does not allocate.
void advance(const StagePlant& plant, StageState& state, double macro_V, double micro_V);

/// Plate x under the optical axis in mm: macro + micro.
double camera_position_mm(const StageState& state);

}  // namespace fidservo::plant
