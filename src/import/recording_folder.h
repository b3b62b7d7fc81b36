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

/// Writes the folder whole or not at all: it has another name until everything is in it. Throws InputError if
/// it exists, a frame cannot be decoded or an interrupt was requested; RunFault if the disk does not take it.
/// @param camera  whose images the detections are of, for cam0/sensor.yaml; empty: not stated
void write_folder(const std::filesystem::path& folder, const Assembled& made,
                  const std::optional<CameraParameters>& camera = std::nullopt);

/// stage0/data.csv: each column with the decimals that its log has, or else with the fewest, from those of a
/// recording up to 12, that restore every number exactly; else each number in its shortest form.
std::string stage_text(const Recording& recording, const ColumnDecimals& decimals);

/// cam0/detections.csv in the same way.
std::string detections_text(const std::vector<TagDetection>& detections);

/// Gives a recording in memory what only a reader of its folder finds: the step of its setpoints, by the
/// decimals with which stage_text writes them, and the plate's print of its tags.
void make_as_read(Recording& recording, const ColumnDecimals& decimals);

/// Setpoints are known to their last digit: the decimals that this is.
int setpoint_decimals(const Recording& recording);

/// The decimals of a recording that has no log: those of its setpoints are known, no others.
ColumnDecimals decimals_without_log(const Recording& recording);

}  // namespace fidservo::imports
