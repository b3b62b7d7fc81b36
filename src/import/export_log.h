// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A recording as signals that other programs read, with the map by which an import gives it back.
#include "src/import/log.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace fidservo::imports {

/// Of a column's title "macro_setpoint [mm]": "macro_setpoint_mm", a name for MATLAB and Python; of px^2
/// "px2".
std::string exported_name(std::string_view title);

enum class ExportFormat { mat, hdf5, csv };

/// Writes FILE; as CSV also FILE's stem with -detections.csv, where there are some, and with .map.yaml. The
/// others carry the map, and a plate file. Throws InputError: the recording, or a file that exists; RunFault
/// if the disk does not take it.
/// @return sentences on what was written
std::vector<std::string> export_recording(const std::filesystem::path& recording, ExportFormat format,
                                          const std::filesystem::path& file);

}  // namespace fidservo::imports
