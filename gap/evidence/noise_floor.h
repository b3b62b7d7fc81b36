// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The noise of sensors, estimated from stretches in which their input is constant.
//
// A reading with noise of standard deviation s about a mean m, rounded to steps of 1, has a variance V(m, s)
// that depends on where m lies between two steps; on average over a step it is s^2 + 1/12. Since a stage
// usually rests at one place, this average does not apply. Therefore s is chosen such that the variances V of
// all stretches add up to the observed ones:
//
//     sum over stretches of  (sum of squares) - (rows - 2) V(mean, s) = 0
//
// with the squares of each stretch taken about a straight line fitted to it.
#include "core/recording.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace fidservo::gap {

/// Variance, after rounding to whole numbers, of normal noise about a mean.
double rounded_variance(double mean, double noise);

/// Statistics of a sensor's readings, in its steps, in a stretch without events.
struct QuietStretch {
    double mean;
    double square_sum;  ///< about the fitted straight line
    std::size_t rows;
};

/// Stretches of 200 rows in which `held`, the input of the sensor's block, is constant and a straight line
/// through the readings rises by less than a step.
std::vector<QuietStretch> quiet_stretches(const std::vector<double>& reading,
                                          const std::vector<double>& held);

/// The noise before rounding, in steps; empty without stretches.
std::optional<double> noise_before_rounding(std::vector<QuietStretch> stretches);

/// The floor of a sensor, in steps: root of noise^2 + 1/12.
double floor_of(double noise);

/// Noise of a corner coordinate in px, from the differences between detections of one tag in neighbouring
/// frames across the stage's axis, where its motion does not show. In a recording that refines corners only
/// refined ones count. Empty with fewer than 20 such pairs.
/// @param frame_s  time between two frames
std::optional<double> corner_noise_px(const std::vector<Recording>& recordings, double frame_s);

}  // namespace fidservo::gap
