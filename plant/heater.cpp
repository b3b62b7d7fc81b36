#include "plant/heater.h"

#include "core/failure.h"
#include "core/micro_model.h"

#include <cmath>

namespace fidservo::plant {

Heater make_heater(const HeaterParameters& parameters, double tick_s) {
    FIDSERVO_DEMAND(tick_s > 0.0 && parameters.heating_tau_s > 0.0 && parameters.cooling_tau_s > 0.0);
    return {parameters, -std::expm1(-tick_s / parameters.heating_tau_s),
            -std::expm1(-tick_s / parameters.cooling_tau_s)};
}

void advance(const Heater& heater, HeaterState& state, double command_V) {
    const double way_degC =
        heater_rise_degC(heater.parameters, command_V) - (state.temp_degC - heater.parameters.ambient_degC);
    state.temp_degC += way_degC * (way_degC > 0.0 ? heater.heating_share : heater.cooling_share);
}

}  // namespace fidservo::plant
