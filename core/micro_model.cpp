// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/micro_model.h"

#include "core/micro_parameters.h"

#include <algorithm>
#include <cmath>

namespace fidservo {

MicroModel nominal_micro_model(const MicroParameters& micro) {
    return {micro.heater, micro.fod, 1.0, micro.hall, {micro.hall.centre_mm, 1.0, 0.0, 0.0}};
}

double platform_position_mm(const MicroModel& model, double hall_adc) {
    const double d = hall_position_mm_of_adc(model.hall, hall_adc) - model.hall.centre_mm;
    const auto& k = model.hall_correction;
    return k[0] + d * (k[1] + d * (k[2] + d * k[3]));
}

double heater_rise_degC(const HeaterParameters& heater, double command_V) {
    return heater.gain_degC_per_V * std::max(0.0, std::min(command_V, heater.limit_V) - heater.onset_V);
}

double heater_command_V(const HeaterParameters& heater, double temp_degC, double rate_degC_per_s) {
    const double tau_s = rate_degC_per_s > 0.0 ? heater.heating_tau_s : heater.cooling_tau_s;
    return heater.onset_V +
           (temp_degC - heater.ambient_degC + tau_s * rate_degC_per_s) / heater.gain_degC_per_V;
}

double heater_step_degC(const HeaterParameters& heater, double temp_degC, double command_V, double time_s) {
    return heated_degC(heater, temp_degC, heater_rise_degC(heater, command_V), time_s);
}

double heated_degC(const HeaterParameters& heater, double temp_degC, double rise_degC, double time_s) {
    const double end_degC = heater.ambient_degC + rise_degC;
    const double tau_s = end_degC > temp_degC ? heater.heating_tau_s : heater.cooling_tau_s;
    return end_degC + (temp_degC - end_degC) * std::exp(-time_s / tau_s);
}

}  // namespace fidservo
