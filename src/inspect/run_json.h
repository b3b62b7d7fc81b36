// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A summary of the run for scripts.
#include "src/inspect/journal.h"
#include "src/inspect/recipe/recipe.h"
#include "src/inspect/report/device_figures.h"

#include <filesystem>

namespace fidservo::inspect {

/// Writes run.json: fingerprints, seed, version, counts, the outcome, and each visit with its times on the
/// rig's clock and what went wrong; on a real rig how punctual the control loop was and what became of the
/// camera's frames, since the run was last taken up. Throws RunFault if the disk does not take it.
void write_run_json(const std::filesystem::path& file, const Recipe& recipe, const JournalContent& content,
                    const DeviceFigures& devices);

}  // namespace fidservo::inspect
