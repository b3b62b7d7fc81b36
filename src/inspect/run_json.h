#pragma once
// The run in one file for scripts.
#include "control/loop_statistics.h"
#include "src/inspect/journal.h"
#include "src/inspect/recipe.h"

#include <filesystem>
#include <optional>

namespace fidservo::inspect {

/// Writes run.json: fingerprints, seed, version, counts, the outcome, and each visit with its times on the
/// rig's clock and what went wrong; on a real rig how punctual the control loop was, since the run was last
/// taken up. Throws RunFault if the disk does not take it.
void write_run_json(const std::filesystem::path& file, const Recipe& recipe, const JournalContent& content,
                    const std::optional<control::LoopStatistics>& loop);

}  // namespace fidservo::inspect
