#pragma once
// The report of an inspection: one HTML file that works offline.
#include "src/inspect/device_figures.h"
#include "src/inspect/journal.h"
#include "src/inspect/output.h"
#include "src/inspect/recipe.h"
#include "src/inspect/rig_findings.h"

#include <optional>

namespace fidservo {
struct Rig;
}

namespace fidservo::inspect {

/// Reads images and recordings back from the output folder. Throws RunFault if the disk does not take it.
/// @param findings  what the recordings say of the rig, if that was asked
void write_inspection_report(const OutputFolder& output, const Recipe& recipe, const Rig& rig,
                             const JournalContent& content, const DeviceFigures& devices,
                             const std::optional<RigFindings>& findings);

}  // namespace fidservo::inspect
