// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The experiments of the published system, on the simulated rig, in one report.
#include "src/reproduce/chapter.h"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace fidservo::reproduce {

/// Runs all chapters on a rig and writes out/report.html, out/claims.csv and out/recordings/. The folder
/// exists.
/// @return all claims, in the report's order
/// Throws InputError if the rig lacks a part or a controller that the published system has, RunFault if the
/// disk fails.
std::vector<Claim> reproduce(const std::filesystem::path& rig_file, const std::filesystem::path& out,
                             std::uint64_t seed);

}  // namespace fidservo::reproduce
