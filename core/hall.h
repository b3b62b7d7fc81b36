// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The linear Hall sensor that sees the micro platform: published S-shaped curve of voltage against position.
//
//     s = (x - centre) / half_range,     V = mid + span s (1 + cubic (1 - s^2))
//
// The curve rises up to |s| = sqrt((1 + cubic) / (3 cubic)); beyond, it has no inverse.

namespace fidservo {

/// The sensor's curve and its converter, as the top of core/hall.h uses them.
struct HallParameters {
    double mid_V;          ///< voltage at the centre
    double span_V;         ///< voltage from the centre to either end
    double centre_mm;      ///< place of the platform where the field is zero
    double half_range_mm;  ///< from the centre to either end of the curve
    double cubic;          ///< coefficient of the S shape; above -1, at least 0 in a rig file
    int adc_bits;          ///< of the converter
    double adc_range_V;    ///< full scale of the converter
    double noise_lsb;      ///< standard deviation before rounding
};

/// The voltage of one step of the converter, V.
double hall_lsb_V(const HallParameters& hall);

/// Sensor voltage in V at a platform position in mm.
double hall_voltage_V(const HallParameters& hall, double position_mm);

/// dV/dx in V/mm.
double hall_slope_V_per_mm(const HallParameters& hall, double position_mm);

/// Exact inverse, not clamped to the travel; voltages beyond the rising part give its end.
double hall_position_mm(const HallParameters& hall, double voltage_V);

/// Position in mm for an ADC reading, or for the mean of several.
double hall_position_mm_of_adc(const HallParameters& hall, double adc);

}  // namespace fidservo
