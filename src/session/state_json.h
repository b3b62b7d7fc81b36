// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// States as JSON, exact to the last bit, for checkpoints.
#include "control/positioner.h"
#include "core/micro_model.h"
#include "plant/stage_plant.h"

#include <nlohmann/json_fwd.hpp>

namespace fidservo {

nlohmann::json json_of(const PreisachMemory& wire);
nlohmann::json json_of(const HeaterParameters& heater);
nlohmann::json json_of(const plant::DelayLineState& line);
nlohmann::json json_of(const plant::StageState& state);
/// For a positioner between motions. The state within a motion is not included.
nlohmann::json json_of(const control::PositionerState& state);

// Each restores what json_of() wrote. Throws nlohmann::json::exception on other text.
void read_json(const nlohmann::json& json, PreisachMemory& wire);
void read_json(const nlohmann::json& json, HeaterParameters& heater);
void read_json(const nlohmann::json& json, plant::DelayLineState& line);
void read_json(const nlohmann::json& json, plant::StageState& state);
void read_json(const nlohmann::json& json, control::PositionerState& state);

}  // namespace fidservo
