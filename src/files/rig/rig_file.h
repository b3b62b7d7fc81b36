// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

namespace fidservo {

struct Rig;

/// Reads a rig file (assets/rig.yaml is the reference rig) and the FOD table it names. Parts that the rig
/// does not have may be left out. Throws InputError.
Rig load_rig(const std::filesystem::path& file);

/// A rig file and the files that it names: everything that load_rig() reads. Throws InputError.
std::vector<std::filesystem::path> files_of_rig(const std::filesystem::path& file);

/// The reference rig that is installed with the program: used where --rig is not given.
std::filesystem::path reference_rig_file();

}  // namespace fidservo
