// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A printed line: its width, where it is thinnest, and where it runs.
#include "core/plate.h"
#include "core/result.h"
#include "vision/features/rest_image.h"

namespace fidservo::vision {

struct LineMeasurement {
    Measured width_um;             ///< mean over the length seen
    Measured narrowest_um;         ///< of the narrowest section; 0 where the line is broken. Its uncertainty
                                   ///< allows for its being the least of many noisy ones
    Eigen::Vector2d narrowest_mm;  ///< where that is, plate frame
    Measured offset_um;       ///< of the centre line from the nominal one, at the middle of the length seen,
                              ///< along the nominal direction turned by +90 degrees (from x towards y)
    Measured x_um;            ///< the centre line's point there, plate frame; along the line it has the
    Measured y_um;            ///< nominal place, and all uncertainty is that across the line
    Measured angle_rad;       ///< from plate x towards y
    double section_um = 0.0;  ///< length of a section: a thinner place shorter than this is averaged
    double length_um = 0.0;   ///< length of line that was seen
    EdgeQuality quality;
};

/// Fits two edges, jointly, to each section along the line. A line that leaves the image is measured on the
/// part that is seen, at least 24 px. The ends are left out. Failures as for measure_dot.
Result<LineMeasurement> measure_line(const RestImage& image, const Line& nominal,
                                     const SearchOptions& options = {});

}  // namespace fidservo::vision
