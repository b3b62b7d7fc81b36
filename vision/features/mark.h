// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A printed dot: its position and size.
#include "core/plate.h"
#include "core/result.h"
#include "vision/features/rest_image.h"

namespace fidservo::vision {

struct DotMeasurement {
    Measured x_um;  ///< centre in the plate frame; includes the uncertainty of the camera position
    Measured y_um;
    Measured diameter_um;
    EdgeQuality quality;
};

/// Fits a circle to the edge found in sections around the dot.
///
/// In each section the edge is located on the pixels themselves (no interpolation) with an erf profile, and
/// the offsets d_k from the circle (c, R) give its correction by weighted, robust least squares,
///     d_k = n_k . dc + dR,
/// repeated until it vanishes. Blur moves the half-way level of a round edge inwards by sigma^2 / (2 R)
/// (first order of the heat equation in polar coordinates); that is corrected.
///
/// Fails with feature_not_found (nothing there, or too faint), not_identifiable (partly outside the image, or
/// two candidates), occluded (too much of the outline hidden or not round), glare (saturated),
/// no_convergence.
Result<DotMeasurement> measure_dot(const RestImage& image, const Dot& nominal,
                                   const SearchOptions& options = {});

}  // namespace fidservo::vision
