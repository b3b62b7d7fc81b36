// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "src/fleet/report/findings.h"

#include <filesystem>

namespace fidservo::fleet {

/// Writes a copy of a rig file with what all units share, beside or in one with the effects that it states
/// (RigEdit::add_effect), with the fleet's values. One that was written before is replaced.
/// @return whether there is such a thing
/// Throws InputError if the source is no rig file.
bool write_cured_rig(const std::filesystem::path& file, const std::filesystem::path& source,
                     const FleetFindings& findings);

}  // namespace fidservo::fleet
