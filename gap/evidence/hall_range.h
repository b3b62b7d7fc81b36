// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The range of readings in which a Hall sensor measures the platform's position.
//
// A converter saturates at 0 and at its highest value; an amplifier in front of it may saturate earlier. The
// reading is then constant, whereas a noisy reading is constant only for a moment: with noise of r.m.s. sigma
// LSB a reading repeats with a probability of at most p = erf(1 / (2 sqrt(2) sigma)), so that n equal
// readings in a row with p^n < 1e-9 are evidence of saturation.
#include "core/hall.h"
#include "core/recording.h"

#include <vector>

namespace fidservo::gap {

/// The readings at which the sensor saturates, LSB; they contain no information on the position.
struct HallRange {
    double low_adc = 0.0, high_adc = 4095.0;
};

/// Displacement of the platform per step (LSB) of the converter, in the middle of its range.
double mm_per_lsb(const HallParameters& hall);

/// A reading, or NaN where it is missing or not between the ends of the range.
double within(const HallRange& range, double hall_adc);

/// The converter's range, or a narrower one where the lowest or highest reading of all recordings shows
/// saturation.
HallRange hall_range(const std::vector<Recording>& recordings, const HallParameters& hall);

}  // namespace fidservo::gap
