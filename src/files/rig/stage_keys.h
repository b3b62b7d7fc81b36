// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a rig file says about the board that drives its stage, and about the limits that are watched: `stage`.
// Only who opens a stage asks.
#include "control/comedi/channel_map.h"
#include "control/watchdog.h"
#include "src/files/text/yaml_reader.h"

#include <filesystem>
#include <optional>

namespace fidservo {

struct Rig;

/// `stage.watchdog`; what is not given stays as it is (control/watchdog.h).
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

/// Those of a rig file; none where it has none. Throws InputError.
StageKeys load_stage_keys(const std::filesystem::path& rig_file);

/// The limits of a rig with those that its file gives.
control::WatchdogParams watchdog_params(const Rig& rig, const WatchdogKeys& keys);

}  // namespace fidservo
