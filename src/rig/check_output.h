// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "src/rig/abilities.h"
#include "src/rig/finding.h"

#include <filesystem>
#include <string>
#include <vector>

namespace fidservo {

/// The two tables for people.
std::string describe(const std::vector<Ability>& abilities, const std::vector<Finding>& findings);

/// {"format": "fidservo-rig-check/1", "rig", "abilities": [{"command", "possible", "missing"}], "findings":
/// [{"key", "value", "why", "usual"}]}. Throws InputError if the file exists, RunFault if the disk fails.
void write_rig_check_json(const std::filesystem::path& file, const std::string& rig_name,
                          const std::vector<Ability>& abilities, const std::vector<Finding>& findings);

}  // namespace fidservo
