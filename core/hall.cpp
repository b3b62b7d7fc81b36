// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/hall.h"

#include <algorithm>
#include <cmath>

namespace fidservo {

double hall_lsb_V(const HallParameters& hall) {
    return hall.adc_range_V / std::exp2(hall.adc_bits);
}

double hall_voltage_V(const HallParameters& hall, double position_mm) {
    const double s = (position_mm - hall.centre_mm) / hall.half_range_mm;
    return hall.mid_V + hall.span_V * s * (1.0 + hall.cubic * (1.0 - s * s));
}

double hall_slope_V_per_mm(const HallParameters& hall, double position_mm) {
    const double s = (position_mm - hall.centre_mm) / hall.half_range_mm;
    return hall.span_V / hall.half_range_mm * (1.0 + hall.cubic - 3.0 * hall.cubic * s * s);
}

double hall_position_mm(const HallParameters& hall, double voltage_V) {
    const double w = (voltage_V - hall.mid_V) / hall.span_V;
    if (hall.cubic == 0.0) return hall.centre_mm + hall.half_range_mm * w;
    // (1 + c) s - c s^3 = w: with s = 2 sqrt(p) sin(t), p = (1 + c) / (3 c), it is 2 p sqrt(p) c sin(3 t) =
    // w. With c < 0 the hyperbolic sine stands for the sine, and |c| for c.
    if (hall.cubic < 0.0) {
        const double root_p = std::sqrt((1.0 + hall.cubic) / (-3.0 * hall.cubic));
        const double sine = w / (-2.0 * hall.cubic * root_p * root_p * root_p);
        return hall.centre_mm + hall.half_range_mm * 2.0 * root_p * std::sinh(std::asinh(sine) / 3.0);
    }
    const double root_p = std::sqrt((1.0 + hall.cubic) / (3.0 * hall.cubic));
    const double sine = std::clamp(w / (2.0 * hall.cubic * root_p * root_p * root_p), -1.0, 1.0);
    return hall.centre_mm + hall.half_range_mm * 2.0 * root_p * std::sin(std::asin(sine) / 3.0);
}

double hall_position_mm_of_adc(const HallParameters& hall, double adc) {
    return hall_position_mm(hall, adc * hall_lsb_V(hall));
}

}  // namespace fidservo
