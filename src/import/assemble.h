// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A recording out of logs, as a map says.
#include "core/recording.h"
#include "src/files/recording/layout.h"
#include "src/import/import_map.h"
#include "src/import/log.h"

#include <array>
#include <string>
#include <vector>

namespace fidservo::imports {

/// A recording and what goes beside it.
struct Assembled {
    Recording recording;
    RecordingOrigin origin;
    /// By stage_columns: digits behind the point that its log has; -1: not known.
    std::array<int, stage_columns.size()> decimals{};
    const LoggedCamera* camera = nullptr;  ///< of the logs; nullptr: no frames
    std::vector<TimeNs> frame_times_ns;    ///< of the camera's, on the recording's clock
    std::string camera_info;               ///< text of a file of intrinsics; empty: none
    std::vector<std::string> notes;        ///< what was done with each signal, one line each
};

/// Rows are those of the logs where all columns have the same times, a tick apart; otherwise they are a tick
/// apart over the time that all columns share: readings on lines between their samples, commands and
/// setpoints held. A row that falls into a reading's gap is left out. Throws InputError.
Assembled assemble(const std::vector<Log>& logs, const ImportMap& map);

}  // namespace fidservo::imports
