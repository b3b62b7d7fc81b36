// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The camera's noise from frames at rest.

#include "core/result.h"

#include <vector>

#include <opencv2/core/mat.hpp>

namespace fidservo::calib {

/// One grey level of the photon-transfer line.
struct TransferPoint {
    double mean_grey;     ///< of a set of pixels, grey levels
    double variance;      ///< of one pixel from frame to frame, grey levels squared, rounding included
    double variance_std;  ///< standard error
};

/// A camera's noise, with standard errors.
struct PhotonTransfer {
    double full_well_e;                 ///< electrons at the grey level 255
    double full_well_std_e;             ///< its standard error
    double read_noise_e;                ///< 0 if the line's floor is not above rounding
    double read_noise_std_e;            ///< its standard error
    double gain_spread;                 ///< standard deviation of the pixels' gains; 0 if it is not seen
    double gain_spread_std;             ///< its standard error
    std::vector<TransferPoint> points;  ///< what it was fitted to
    double misfit;  ///< mean square of the points about the line in their variances, a degree of freedom
};

/// Mean-variance line and fixed pattern of bursts; the scene and the light stay the same within a burst.
///
///     var(g) = gain mean + (gain read_noise_e)^2 + 1/12,   gain = 255 / full_well_e
///
/// The variance at a grey level is half that of the differences between successive frames, a lamp's flicker
/// removed, over pixels away from edges (a camera that trembles). 1/12 is what rounding to
/// grey levels adds. The gains' spread is the part of the second differences between three neighbouring
/// pixels that the averages of the even and of the odd frames of a burst have in common: 6 spread^2 mean^2;
/// neither temporal noise nor an even slope of the light has a part in it. Source: Janesick, Photon Transfer,
/// SPIE Press 2007, ch. 5; EMVA Standard 1288, rel. 4.0, sec. 6.
/// @param bursts  CV_8UC1, two frames or more each
/// Fails with Reason::not_identifiable if there are too few pixels away from edges, or if grey levels are too
/// alike to tell the line's slope from its floor.
Result<PhotonTransfer> measure_noise(const std::vector<std::vector<cv::Mat>>& bursts);

}  // namespace fidservo::calib
