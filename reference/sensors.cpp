// SPDX-License-Identifier: GPL-3.0-or-later
#include "reference/sensors.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fidservo::reference {

std::int64_t encoder_count(double resolution_mm, const EncoderDepartures& departures, double position_mm) {
    double seen_mm = departures.scale * position_mm;
    if (departures.ripple_mm != 0.0) {
        const double angle = 2.0 * std::numbers::pi * position_mm / departures.ripple_period_mm;
        const double phase = angle + departures.ripple_phase_rad;
        seen_mm += departures.ripple_mm * std::sin(phase + departures.ripple_skew * std::sin(phase));
    }
    const double along_mm = position_mm - departures.bow_centre_mm;
    seen_mm += departures.bow_per_mm * along_mm * along_mm;
    return static_cast<std::int64_t>(std::floor(seen_mm / resolution_mm + 0.5));
}

double hall_volts(const HallParameters& hall, const HallDepartures& departures, const HallInput& input) {
    const double s = (input.platform_mm - hall.centre_mm) / hall.half_range_mm;
    const double cubic = hall.cubic + departures.cubic;
    const double curve_V =
        hall.span_V * s *
        ((1.0 + cubic) - (cubic - departures.cube) * s * s + departures.fifth * (1.0 - s * s * s * s));
    const double settling_s = departures.drift_settling_s;
    const double slowing_s = departures.drift_slowing_s;
    const double drifted_s = settling_s > 0.0  ? settling_s * (1.0 - std::exp(-input.time_s / settling_s))
                             : slowing_s > 0.0 ? slowing_s * std::log1p(input.time_s / slowing_s)
                                               : input.time_s;
    return departures.supply * (hall.mid_V + departures.gain * curve_V) + departures.offset_V +
           departures.drift_V_per_s * drifted_s + departures.crosstalk_V_per_V * input.macro_V +
           departures.warm_V_per_degC * input.warmer_degC;
}

int hall_reading(const HallParameters& hall, double volts, NoiseStream& noise) {
    const int codes = 1 << hall.adc_bits;
    const double lsb = volts * codes / hall.adc_range_V + hall.noise_lsb * noise.normal();
    return std::clamp(static_cast<int>(std::lround(lsb)), 0, codes - 1);
}

}  // namespace fidservo::reference
