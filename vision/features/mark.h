// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A printed dot: where it is and how large.
#include "core/plate.h"
#include "core/result.h"
#include "vision/features/rest_image.h"

namespace fidservo::vision {

struct DotMeasurement {
    Measured x_um;  ///< centre, plate frame; includes the camera position's uncertainty
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
/// (first order of the heat equation in polar coordinates); that is put right.
///
/// Fails with feature_not_found (nothing, or too faint), not_identifiable (partly outside the image, or two
/// candidates), occluded (too much of the outline hidden or not round), glare (saturated), no_convergence.
Result<DotMeasurement> measure_dot(const RestImage& image, const Dot& nominal,
                                   const SearchOptions& options = {});

}  // namespace fidservo::vision
