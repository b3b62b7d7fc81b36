// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Assembles a recording from logs by a map.
#include "core/recording.h"
#include "src/files/recording/layout.h"
#include "src/import/import_map.h"
#include "src/import/log.h"

#include <array>
#include <string>
#include <vector>

namespace fidservo::imports {

/// For each of stage_columns: digits after the decimal point in its log; -1: unknown.
using ColumnDecimals = std::array<int, stage_columns.size()>;

/// A recording and its accompanying files.
struct Assembled {
    Recording recording;
    RecordingOrigin origin;
    ColumnDecimals decimals{};
    const LoggedCamera* camera = nullptr;  ///< the logs' camera; nullptr: no frames
    std::vector<TimeNs> frame_times_ns;    ///< the camera's frame times on the recording's clock
    std::string camera_info;               ///< text of a file of intrinsics; empty: none
    std::vector<std::string> notes;        ///< how each signal was treated, one line each
};

/// If all columns have the same times, a tick apart, the rows are those of the logs. Otherwise the rows are a
/// tick apart over the time that all columns cover; readings are interpolated linearly, commands and
/// setpoints are held. A row within a gap of a reading is left out. Throws InputError.
Assembled assemble(const std::vector<Log>& logs, const ImportMap& map);

}  // namespace fidservo::imports
