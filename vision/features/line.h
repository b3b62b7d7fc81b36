// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A printed line: its width, its narrowest place, its position and its angle.
#include "core/plate.h"
#include "core/result.h"
#include "vision/features/rest_image.h"

namespace fidservo::vision {

struct LineMeasurement {
    Measured width_um;  ///< mean over the visible length
    /// of the narrowest section; 0 where the line is broken. Its uncertainty allows for the selection of the
    /// least of many noisy values.
    Measured narrowest_um;
    Eigen::Vector2d narrowest_mm;  ///< place of the narrowest section, plate frame
    /// Offset of the centre line from the nominal one at the middle of the visible length, along the nominal
    /// direction turned by +90 degrees (from x towards y).
    Measured offset_um;
    Measured x_um;       ///< that middle point of the centre line, plate frame; along the line it has the
    Measured y_um;       ///< nominal place, so that all of its uncertainty is across the line
    Measured angle_rad;  ///< from plate x towards y
    double section_um = 0.0;  ///< length of a section: narrow places shorter than this are averaged
    double length_um = 0.0;   ///< visible length of the line
    EdgeQuality quality;
};

/// Fits both edges jointly in each section along the line. A line that leaves the image is measured on its
/// visible part, which must be 24 px or longer. The ends are left out. Failures are those of measure_dot.
Result<LineMeasurement> measure_line(const RestImage& image, const Line& nominal,
                                     const SearchOptions& options = {});

}  // namespace fidservo::vision
