// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The parts of an inspection's report, each as HTML.
#include "src/inspect/journal.h"
#include "src/inspect/measure/output.h"
#include "src/inspect/recipe/recipe.h"
#include "src/report/page.h"

#include <string>

namespace fidservo::inspect {

report::Mood mood_of(Outcome outcome);
/// A coloured word with a sign, so that it is readable without colour.
std::string badge(Outcome outcome);

/// The failed checks, one line for each row.
std::string findings_html(const std::vector<Visit>& visits);
/// The plate with its fiducials, and each site's field of view in the colour of its outcome.
std::string plate_html(const Recipe& recipe, const CameraGeometry& camera, const std::vector<Visit>& visits);
/// Each site's images with what was measured drawn over them.
std::string sites_html(const OutputFolder& output, const CameraGeometry& camera,
                       const std::vector<Visit>& visits);
/// All rows, with filters.
std::string checks_html(const std::vector<Visit>& visits);
/// Histogram of deviations relative to their tolerance, by kind of check.
std::string histogram_html(const std::vector<Visit>& visits);
/// Fingerprints and versions.
std::string footer_html(const JournalContent& content);

}  // namespace fidservo::inspect
