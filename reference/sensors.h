// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the board reads: the carriage's encoder and the platform's Hall sensor.
#include "core/hall.h"
#include "core/random.h"
#include "reference/departures.h"

#include <cstdint>

namespace fidservo::reference {

/// Count for a carriage position: the nearest one, halves rounded upwards.
std::int64_t encoder_count(double resolution_mm, const EncoderDepartures& departures, double position_mm);

/// What the Hall sensor's voltage depends on.
struct HallInput {
    double platform_mm;
    double macro_V;            ///< the motor command in force, behind the crosstalk's low-pass
    double time_s;             ///< since the start
    double warmer_degC = 0.0;  ///< the wire's temperature above the nominal room's
};

/// Voltage before noise and rounding: V = supply (mid + gain span ((1 + c) s - c s^3 + d s^3 + e (s - s^5)))
/// + offset + drift(t) + crosstalk u
///     + warm (T - Ta),  s = (x - centre) / half range. drift(t) grows in proportion to
/// time, or settles exponentially, or goes on as a logarithm of time.
double hall_volts(const HallParameters& hall, const HallDepartures& departures, const HallInput& input);

/// The ADC's reading, 0 .. 2^bits - 1, for a voltage with noise.
int hall_reading(const HallParameters& hall, double volts, NoiseStream& noise);

}  // namespace fidservo::reference
