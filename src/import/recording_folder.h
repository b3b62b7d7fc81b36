// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Writes an imported recording as a folder, with every number as it was logged.
#include "core/camera/camera_parameters.h"
#include "src/import/assemble.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace fidservo::imports {

/// Writes the folder completely or not at all: it has a temporary name until it is complete. Throws
/// InputError if it exists, a frame cannot be decoded or an interrupt was requested; RunFault if the disk
/// fails.
/// @param camera  the camera of the detections, for cam0/sensor.yaml; empty: unknown
void write_folder(const std::filesystem::path& folder, const Assembled& made,
                  const std::optional<CameraParameters>& camera = std::nullopt);

/// The text of stage0/data.csv. Each column has as many decimals as its log or, if these are unknown, the
/// fewest that restore every number exactly, between the usual number of a recording and 12. If 12 are not
/// enough, each number is written in its shortest exact form.
std::string stage_text(const Recording& recording, const ColumnDecimals& decimals);

/// The text of cam0/detections.csv, with decimals chosen in the same way.
std::string detections_text(const std::vector<TagDetection>& detections);

/// Sets those fields of a recording that reading its folder would set: the resolution of the setpoints, from
/// the decimals with which stage_text() writes them, and the print of the tags, from the plate.
void make_as_read(Recording& recording, const ColumnDecimals& decimals);

/// The number of decimals that corresponds to the recording's resolution of setpoints.
int setpoint_decimals(const Recording& recording);

/// The decimals of a recording that was not imported from a log: known for the setpoints only.
ColumnDecimals decimals_without_log(const Recording& recording);

}  // namespace fidservo::imports
