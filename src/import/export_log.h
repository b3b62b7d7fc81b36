// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Exports a recording as signals for other programs, with the map by which an import restores it.
#include "src/import/log.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace fidservo::imports {

/// A column's name for MATLAB and Python: "macro_setpoint_mm" for the title "macro_setpoint [mm]", "px2" for
/// px^2.
std::string exported_name(std::string_view title);

enum class ExportFormat { mat, hdf5, csv };

/// Writes FILE; as CSV also FILE's stem with -detections.csv, where there are some, and with .map.yaml. The
/// others carry the map, and a plate file. Throws InputError: the recording, or a file that exists; RunFault
/// if the disk does not take it.
/// @return sentences on what was written
std::vector<std::string> export_recording(const std::filesystem::path& recording, ExportFormat format,
                                          const std::filesystem::path& file);

}  // namespace fidservo::imports
