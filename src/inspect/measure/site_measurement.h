// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Evaluates a site's images: makes the checks of every view, and writes the images to disk.
#include "src/inspect/measure/checks.h"
#include "src/inspect/measure/output.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace fidservo::inspect {

/// The common data of all measurements in a run.
struct Measuring {
    const Recipe& recipe;
    const CameraParameters& camera;
    const OutputFolder& output;
    const DrawNominal& draw_nominal;
    vision::TagDetector& detector;
};

/// The snapshots of a site's views, in their order; empty for a view that has not succeeded.
using Snapshots = std::vector<std::optional<Snapshot>>;

/// The message for a view's rows on failed attempts; empty if there were none.
using Trouble = std::function<std::string(const View& view)>;

/// Fills in the visit's rows and views; the images are on the disk when this returns. Views without a
/// snapshot have `not_measured` rows. Throws RunFault if the disk does not take an image.
void measure_site(const Measuring& measuring, const Site& site, const Snapshots& snapshots,
                  const Trouble& trouble, Visit& visit);

}  // namespace fidservo::inspect
