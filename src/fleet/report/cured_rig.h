// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "src/fleet/report/findings.h"

#include <filesystem>
#include <string>
#include <vector>

namespace fidservo::fleet {

/// What came of it.
struct CuredRig {
    bool is_written = false;
    /// Effects that all units share, but with different shapes, periods, phases or choices: no one rig file
    /// cures them.
    std::vector<std::string> left_out;
};

/// Writes a copy of a rig file with what all units share, beside or in one with the effects that it states
/// (RigEdit::add_effect), with the fleet's values of the sizes and what diagnoses agree on of the other
/// parameters. One that was written before is replaced, or removed if there is nothing to be cured.
/// Throws InputError if the source is no rig file.
CuredRig write_cured_rig(const std::filesystem::path& file, const std::filesystem::path& source,
                         const std::vector<FleetResult>& results, const FleetFindings& findings);

}  // namespace fidservo::fleet
