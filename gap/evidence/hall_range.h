// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Between which readings a Hall sensor tells where the platform is.
//
// A converter ends at 0 and at its highest value; an amplifier in front of it may end earlier. Then the
// reading stands still at its own end, which a noisy reading otherwise does for moments only: with noise of
// r.m.s. sigma LSB a reading repeats with a probability of p = erf(1 / (2 sqrt(2) sigma)) at most, and n
// equal ones in a row, with p^n < 1e-9, are no chance.
#include "core/hall.h"
#include "core/recording.h"

#include <vector>

namespace fidservo::gap {

/// The ends, which are no readings of a place themselves, in LSB.
struct HallRange {
    double low_adc = 0.0, high_adc = 4095.0;
};

/// How far the platform moves per step of the converter, in the middle of its range.
double mm_per_lsb(const HallParameters& hall);

/// A reading, or NaN where it is missing or at an end of the range.
double within(const HallRange& range, double hall_adc);

/// The converter's range, or where the lowest or highest reading of all recordings shows an end, that one.
HallRange hall_range(const std::vector<Recording>& recordings, const HallParameters& hall);

}  // namespace fidservo::gap
