// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A printed rectangle: its position, size and angle.
#include "core/plate.h"
#include "core/result.h"
#include "vision/features/rest_image.h"

namespace fidservo::vision {

struct PadMeasurement {
    Measured x_um;  ///< centre in the plate frame; includes the uncertainty of the camera position
    Measured y_um;
    Measured width_um;   ///< along the pad's own x
    Measured height_um;  ///< along the pad's own y
    Measured angle_rad;  ///< from plate x towards y
    EdgeQuality quality;
};

/// Fits a rectangle to the edge located in sections along its four sides, away from the corners. Method and
/// failures are those of measure_dot; the pad's sides must be at least 16 px long.
Result<PadMeasurement> measure_pad(const RestImage& image, const Pad& nominal,
                                   const SearchOptions& options = {});

}  // namespace fidservo::vision
