// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What is made of a site's images: the checks of every view, the images on the disk.
#include "src/inspect/measure/checks.h"
#include "src/inspect/measure/output.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace fidservo::inspect {

/// What every measurement of a run needs.
struct Measuring {
    const Recipe& recipe;
    const CameraParameters& camera;
    const OutputFolder& output;
    const DrawNominal& draw_nominal;
    vision::TagDetector& detector;
};

/// Snapshots of a site's views, in their order; empty where none has succeeded yet.
using Snapshots = std::vector<std::optional<Snapshot>>;

/// What the rows of a view are to say of tries that failed; empty if there were none.
using Trouble = std::function<std::string(const View& view)>;

/// Fills in the visit's rows and views; the images are on the disk when this returns. Views without a
/// snapshot have `not_measured` rows. Throws RunFault if the disk does not take an image.
void measure_site(const Measuring& measuring, const Site& site, const Snapshots& snapshots,
                  const Trouble& trouble, Visit& visit);

}  // namespace fidservo::inspect
