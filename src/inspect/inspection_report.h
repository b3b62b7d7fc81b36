#pragma once
// The report of an inspection: one HTML file that works offline.
#include "src/inspect/device_figures.h"
#include "src/inspect/journal.h"
#include "src/inspect/output.h"
#include "src/inspect/recipe.h"

namespace fidservo {
struct Rig;
}

namespace fidservo::inspect {

/// Reads images and recordings back from the output folder. Throws RunFault if the disk does not take it.
void write_inspection_report(const OutputFolder& output, const Recipe& recipe, const Rig& rig,
                             const JournalContent& content, const DeviceFigures& devices);

}  // namespace fidservo::inspect
