// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "core/fiducial_parameters.h"
#include "core/plate.h"
#include "src/files/text/yaml_reader.h"

#include <filesystem>
#include <string>
#include <vector>

namespace fidservo {

struct Rig;

/// Reads a plate file (docs/formats.md): tags and printed features at known places. Throws InputError.
Plate load_plate(const std::filesystem::path& file);

/// The same from a map inside another file, e.g. a recipe's `plate`.
Plate read_plate(const YamlValue& map);

/// The text of a plate file with these tags and no features.
std::string plate_yaml(const std::vector<PlateTag>& tags);

/// One printed feature of a plate file's `features`.
/// @param ink_reflectance  the default for a feature that states none
Feature read_feature(const YamlValue& map, double ink_reflectance);

/// The plate that a rig file describes: its grid of fiducials and nothing else.
Plate plate_of(const FiducialParameters& fiducials);

/// The plate of a rig, for commands that need one. Throws InputError if the rig has no fiducials.
/// @param rig_file  the rig's file, for the message
Plate rig_plate(const Rig& rig, const std::filesystem::path& rig_file);

}  // namespace fidservo
