// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The variance of a pixel's grey level, from the camera's data sheet or its calibration.

#include "core/camera/camera_parameters.h"

#include <cmath>

namespace fidservo::vision {

/// var(g) = gain g + (spread g)^2 + (gain read_noise_e)^2 + 1/12,  gain = 255 / full_well_e  (shot noise, the
/// pixels' unequal gains, read noise, rounding; grey levels squared)
struct GreyNoise {
    double gain_grey_per_e;    ///< gain: grey levels per electron
    double floor_variance;     ///< read noise and rounding, grey levels squared
    double gain_spread = 0.0;  ///< standard deviation of the pixels' gains

    /// var(g) of a pixel at a mean grey level.
    double variance(double grey) const {
        const double light = grey > 0.0 ? grey : 0.0;
        return gain_grey_per_e * light + gain_spread * gain_spread * light * light + floor_variance;
    }
};

/// The grey level of a saturated pixel.
inline constexpr double white_grey = 255.0;

/// The noise of a camera with the parameters of its rig file.
inline GreyNoise grey_noise(const CameraParameters& camera) {
    const double gain = white_grey / camera.full_well_e;
    return {gain, std::pow(gain * camera.read_noise_e, 2) + 1.0 / 12.0, camera.gain_spread};
}

}  // namespace fidservo::vision
