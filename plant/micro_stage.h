#pragma once
// The micro stage: heater -> wire with hysteresis -> flexure platform -> Hall sensor. The platform moves with
// the wire:  x = stroke factor * Preisach(T).
#include "core/preisach.h"
#include "plant/hall_sensor.h"
#include "plant/heater.h"

#include <memory>
#include <optional>

namespace fidservo::plant {

struct MicroStageParameters {
    HeaterParameters heater;
    std::shared_ptr<const FodTable> fod;
    double stroke_factor = 1.0;  ///< contraction per contraction of the table
    HallParameters hall;
};

/// Immutable.
struct MicroStage {
    Heater heater;
    std::shared_ptr<const FodTable> fod;
    double stroke_factor;
    HallSensor hall;
};

struct MicroStageState {
    HeaterState heater;
    PreisachMemory wire;
    double position_mm;  ///< of the platform, 0 where the wire is fully extended
    NoiseStream hall_noise;
};

/// The micro stage of a rig, without effects; empty if it has none.
std::optional<MicroStageParameters> micro_stage_parameters(const Rig& rig);

MicroStage make_micro_stage(const MicroStageParameters& parameters, double tick_s);

/// A wire that was cold for long: at ambient temperature, fully extended.
MicroStageState start(const MicroStage& stage, std::uint64_t seed);

/// One tick under a held command in V. The cost does not grow with the run (core/preisach.h).
void advance(const MicroStage& stage, MicroStageState& state, double command_V);

}  // namespace fidservo::plant
