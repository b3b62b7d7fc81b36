#pragma once
// The report of an inspection: one HTML file that works offline.
#include "control/loop_statistics.h"
#include "core/rig.h"
#include "src/inspect/journal.h"
#include "src/inspect/output.h"
#include "src/inspect/recipe.h"

#include <optional>

namespace fidservo::inspect {

/// Reads images and recordings back from the output folder. Throws RunFault if the disk does not take it.
void write_inspection_report(const OutputFolder& output, const Recipe& recipe, const Rig& rig,
                             const JournalContent& content,
                             const std::optional<control::LoopStatistics>& loop);

}  // namespace fidservo::inspect
