// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Explicit states as JSON, exact to the last bit: what a checkpoint is made of.
#include "control/positioner.h"
#include "core/micro_model.h"
#include "plant/stage_plant.h"

#include <nlohmann/json_fwd.hpp>

namespace fidservo {

nlohmann::json json_of(const PreisachMemory& wire);
nlohmann::json json_of(const HeaterParameters& heater);
nlohmann::json json_of(const plant::DelayLineState& line);
nlohmann::json json_of(const plant::StageState& state);
/// At rest: between motions. What a motion keeps for itself is not part of it.
nlohmann::json json_of(const control::PositionerState& state);

// Each overwrites what json_of() wrote. Throws nlohmann::json::exception on text that it did not write.
void read_json(const nlohmann::json& json, PreisachMemory& wire);
void read_json(const nlohmann::json& json, HeaterParameters& heater);
void read_json(const nlohmann::json& json, plant::DelayLineState& line);
void read_json(const nlohmann::json& json, plant::StageState& state);
void read_json(const nlohmann::json& json, control::PositionerState& state);

}  // namespace fidservo
