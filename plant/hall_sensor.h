// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The Hall sensor with its ADC: the published curve (core/hall.h), Gaussian noise, rounding, clamped to the
// converter's range.
#include "core/hall.h"
#include "core/random.h"

namespace fidservo::plant {

/// The sensor's parameters and constants that follow from them. Immutable.
struct HallSensor {
    HallParameters parameters;
    double lsb_per_V;
    double highest_adc;
};

HallSensor make_hall_sensor(const HallParameters& parameters);

/// The reading before noise and rounding, in LSB, at a platform position in mm.
double mean_reading_lsb(const HallSensor& sensor, double position_mm);

/// One reading. Takes one draw from the noise stream, whatever the parameters are.
/// @param disturbance_V  added to the curve's voltage
int sample(const HallSensor& sensor, NoiseStream& noise, double position_mm, double disturbance_V = 0.0);

}  // namespace fidservo::plant
