// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "src/fleet/report/findings.h"

#include <filesystem>
#include <string>
#include <vector>

namespace fidservo::fleet {

/// The result of write_cured_rig().
struct CuredRig {
    bool is_written = false;
    /// Effects that all units have, but with different shapes, periods, phases or choices, so that no single
    /// rig file can state them.
    std::vector<std::string> left_out;
};

/// Writes a copy of a rig file to which the deviations that all units share are added as effects; effects
/// that the file already states are combined with them (RigEdit::add_effect). Sizes are the fleet's values,
/// the other parameters those on which the diagnoses agree. An earlier copy is replaced, or removed if there
/// is nothing to add. Throws InputError if the source is no rig file.
CuredRig write_cured_rig(const std::filesystem::path& file, const std::filesystem::path& source,
                         const std::vector<FleetResult>& results, const FleetFindings& findings);

}  // namespace fidservo::fleet
