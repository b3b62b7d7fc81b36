// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The noise of sensors, from stretches where nothing happens.
//
// A rounded reading of noise s about a mean m scatters by a variance V(m, s) that depends on where m lies
// between two steps; spread evenly over a step it is s^2 + 1/12. So that a stage that rests in one place, as
// most do, does not mislead, s is found such that the stretches' own V(m, s) add up to what they show:
//
//     sum over stretches of  (sum of squares) - (rows - 2) V(mean, s) = 0
//
// each stretch with its own straight line taken off.
#include "core/recording.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace fidservo::gap {

/// Variance of a mean plus normal noise, rounded to whole numbers.
double rounded_variance(double mean, double noise);

/// What a stretch without events shows of a sensor, in its steps.
struct QuietStretch {
    double mean;
    double square_sum;  ///< about a straight line
    std::size_t rows;
};

/// Stretches of 200 rows in which `held` (what drives the sensor's block) does not change and the readings
/// follow a straight line of less than a step.
std::vector<QuietStretch> quiet_stretches(const std::vector<double>& reading,
                                          const std::vector<double>& held);

/// The noise before rounding; empty without stretches.
std::optional<double> noise_before_rounding(std::vector<QuietStretch> stretches);

/// Root of noise^2 + 1/12.
double floor_of(double noise);

/// Noise of a corner coordinate in px: from how detections of one tag in neighbouring frames differ across
/// the stage's axis, where its motion does not show. Of a recording that refines corners by these alone.
/// Empty with fewer than 20 such pairs.
/// @param frame_s  between two frames
std::optional<double> corner_noise_px(const std::vector<Recording>& recordings, double frame_s);

}  // namespace fidservo::gap
