// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The keys `stage` of a rig file: the board that drives the stage, and the watchdog's limits. Only programs
// that open a stage read them.
#include "control/comedi/channel_map.h"
#include "control/watchdog.h"
#include "src/files/text/yaml_reader.h"

#include <filesystem>
#include <optional>

namespace fidservo {

struct Rig;

/// The keys of `stage.watchdog`; those not given keep their defaults (control/watchdog.h).
struct WatchdogKeys {
    std::optional<int> late_ticks;
    std::optional<double> wire_limit_degC;
    std::optional<double> following_limit_mm;
};

struct StageKeys {
    std::optional<control::comedi::ChannelMap> comedi;
    WatchdogKeys watchdog;
};

/// The keys of `stage`. Throws InputError.
StageKeys read_stage_keys(const YamlValue& map);

/// The keys `stage` of a rig file; defaults where it has none. Throws InputError.
StageKeys load_stage_keys(const std::filesystem::path& rig_file);

/// The watchdog's limits for a rig, with those that its file gives.
control::WatchdogParams watchdog_params(const Rig& rig, const WatchdogKeys& keys);

}  // namespace fidservo
