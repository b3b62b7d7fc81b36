// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The diagnosis of the rig from an inspection's own recordings.
#include "src/inspect/measure/output.h"

#include <filesystem>
#include <string>

namespace fidservo {
struct Rig;
}

namespace fidservo::inspect {

struct RigFindings {
    std::string line;            ///< for the terminal: verdict and path of the report
    std::string html;            ///< of the report's section
    std::string diagnosis = {};  ///< the text of diagnosis.json; empty where there is none
};

/// Diagnoses what homing and visits have recorded, for at most half a minute, and writes OUT/diagnosis.html
/// and OUT/diagnosis.json. If a diagnosis is impossible, the reason is reported instead. Throws RunFault if
/// the disk does not take the files.
RigFindings find_in_recordings(const OutputFolder& output, const Rig& rig,
                               const std::filesystem::path& rig_file);

}  // namespace fidservo::inspect
