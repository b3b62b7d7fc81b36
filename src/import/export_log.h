// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Exports a recording as signals for other programs, with the map with which `import` restores the recording.
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

/// Writes FILE. For CSV, the detections, if there are any, and the map are written to STEM-detections.csv and
/// STEM.map.yaml beside it; the other formats contain the map and the plate file. Throws InputError if the
/// recording is not valid or a file exists; RunFault if the disk fails.
/// @return sentences on what was written
std::vector<std::string> export_recording(const std::filesystem::path& recording, ExportFormat format,
                                          const std::filesystem::path& file);

}  // namespace fidservo::imports
