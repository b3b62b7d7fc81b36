// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/hall_sensor.h"

#include <algorithm>
#include <cmath>

namespace fidservo::plant {

HallSensor make_hall_sensor(const HallParameters& parameters) {
    return {parameters, 1.0 / hall_lsb_V(parameters), std::exp2(parameters.adc_bits) - 1.0};
}

double mean_reading_lsb(const HallSensor& sensor, double position_mm) {
    return hall_voltage_V(sensor.parameters, position_mm) * sensor.lsb_per_V;
}

int sample(const HallSensor& sensor, NoiseStream& noise, double position_mm, double disturbance_V) {
    const double mean_lsb =
        (hall_voltage_V(sensor.parameters, position_mm) + disturbance_V) * sensor.lsb_per_V;
    const double reading_lsb = mean_lsb + sensor.parameters.noise_lsb * noise.normal();
    return static_cast<int>(std::floor(std::clamp(reading_lsb, 0.0, sensor.highest_adc) + 0.5));
}

}  // namespace fidservo::plant
