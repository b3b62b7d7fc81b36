// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// From mean pictures to the frames that a camera delivers.
//
//     electrons = full_well (share of full scale)          + shot noise + unequal gains + read noise
//     grey = round(255 response(electrons / full_well))     response(x) = x^(1 / gamma), clipped to 0..1
//
// As in a camera, noise arises in electrons, before the display gamma; with `noise_after_gamma`, the mean
// goes through the response first, and the noise is a linear camera's. Shot and read noise and a new map of
// gains every frame add up to one normal deviate of their common variance, m + read^2 + (spread m)^2
// electrons^2 at the mean m.
#include "core/random.h"

#include <vector>

#include <opencv2/core/mat.hpp>

namespace fidservo::precision {

struct Sensor {
    double full_well_e = 10000.0;  ///< at full scale, grey level 255
    double read_noise_e = 5.0;
    double gain_spread = 0.0;
    double gamma = 1.0;
    bool noise_after_gamma = false;
};

/// Grey level of a share of full scale, not rounded.
double grey_of(const Sensor& sensor, double share);

/// Variance of a pixel's grey level at a mean share of full scale, with 1/12 for rounding.
double grey_variance(const Sensor& sensor, double share);

/// Noisy frames of one mean picture.
class FrameSource {
  public:
    FrameSource(const Sensor& sensor, const cv::Mat1d& mean_picture);

    /// Draws the pixels of a region anew; the rest of `frame` stays. An empty frame is drawn whole.
    void draw(NoiseStream& noise, cv::Mat1b& frame, const cv::Rect& region) const;

  private:
    unsigned char level_of(float grey) const;

    cv::Mat1f mean_grey_, sigma_grey_;   ///< linear grey levels
    std::vector<unsigned char> levels_;  ///< by 1/64 linear level; empty for a linear camera
};

}  // namespace fidservo::precision
