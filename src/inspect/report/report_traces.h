// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Macro and micro stage over the whole run, from the recordings.
#include "src/inspect/measure/output.h"
#include "src/inspect/measure/results.h"

#include <string>

namespace fidservo {
struct Rig;
}

namespace fidservo::inspect {

/// Plots as HTML; a sentence if there are no recordings. At most `most_points` of the ticks are shown, chosen
/// so that no peak of the platform's motion is lost.
std::string traces_html(const OutputFolder& output, const Rig& rig, const std::vector<Visit>& visits,
                        std::size_t most_points = 60000);

}  // namespace fidservo::inspect
