// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The report of an inspection: one HTML file that works offline.
#include "src/inspect/journal.h"
#include "src/inspect/measure/output.h"
#include "src/inspect/recipe/recipe.h"
#include "src/inspect/report/device_figures.h"
#include "src/inspect/report/rig_findings.h"
#include "src/report/page.h"

#include <cstddef>

namespace fidservo {
struct Rig;
}

namespace fidservo::inspect {

/// The report without what is only known after the run.
struct InspectionReport {
    report::Page page;
    std::size_t findings_at = 0;  ///< position in its body where the section about the rig is inserted
};

/// Reads images and recordings back from the output folder.
InspectionReport inspection_report(const OutputFolder& output, const Recipe& recipe, const Rig& rig,
                                   const JournalContent& content, const DeviceFigures& devices);

/// The report with a section on the rig's diagnosis.
InspectionReport with_findings(InspectionReport all, const RigFindings& findings);

/// Writes the report. Throws RunFault if the disk fails.
void write_inspection_report(const OutputFolder& output, const InspectionReport& all);

}  // namespace fidservo::inspect
