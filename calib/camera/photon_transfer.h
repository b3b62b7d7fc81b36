// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The camera's noise from frames at rest, by the photon transfer method.

#include "core/result.h"

#include <vector>

#include <opencv2/core/mat.hpp>

namespace fidservo::calib {

/// One point of the photon transfer line.
struct TransferPoint {
    double mean_grey;     ///< mean of a set of pixels
    double variance;      ///< temporal variance of one pixel, grey levels squared, rounding included
    double variance_std;  ///< standard error
};

/// A camera's noise, with standard errors.
struct PhotonTransfer {
    double full_well_e;                 ///< electrons at the grey level 255
    double full_well_std_e;             ///< standard error of full_well_e
    double read_noise_e;                ///< 0 if the line's floor is not above rounding
    double read_noise_std_e;            ///< standard error of read_noise_e
    double gain_spread;                 ///< standard deviation of the pixels' gains; 0 if none is detected
    double gain_spread_std;             ///< standard error of gain_spread
    std::vector<TransferPoint> points;  ///< the points to which the line was fitted
    double misfit;                      ///< chi^2 of the points about the line per degree of freedom
};

/// Fits the mean-variance line, and measures the fixed-pattern noise, from bursts of frames; scene and light
/// must stay the same within a burst.
///
///     var(g) = gain mean + (gain read_noise_e)^2 + 1/12,   gain = 255 / full_well_e
///
/// The variance at a grey level is half that of the differences between successive frames, with a lamp's
/// flicker removed, over pixels away from edges (where a vibrating camera would add variance). 1/12 is the
/// variance of rounding. The gains' spread follows from the covariance of second differences of three
/// neighbouring pixels between the averages of the even and of the odd frames of a burst, 6 spread^2 mean^2;
/// temporal noise and a linear gradient of the light drop out. Source: Janesick, Photon Transfer, SPIE Press
/// 2007, ch. 5; EMVA Standard 1288, rel. 4.0, sec. 6.
/// @param bursts  frames CV_8UC1, at least two in each burst
/// @return fails with Reason::not_identifiable if there are too few pixels away from edges, or if the grey
/// levels differ too little to separate the line's slope from its intercept
Result<PhotonTransfer> measure_noise(const std::vector<std::vector<cv::Mat>>& bursts);

}  // namespace fidservo::calib
