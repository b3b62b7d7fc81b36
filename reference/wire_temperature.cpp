// SPDX-License-Identifier: GPL-3.0-or-later
#include "reference/wire_temperature.h"

#include "core/micro_parameters.h"
#include "reference/runge_kutta.h"

#include <algorithm>
#include <cmath>

namespace fidservo::reference {

namespace {

constexpr double no_gain_degC = 200.0, convection_degC = 60.0;

double wire_rate(const WireModel& model, double rise_degC, double temp_degC) {
    const double above_degC = temp_degC - model.ambient_degC;
    if (model.cold_gain != 0.0) rise_degC *= 1.0 + model.cold_gain * (1.0 - above_degC / no_gain_degC);
    const double lacking_degC = rise_degC - above_degC;
    if (lacking_degC > 0.0) return lacking_degC / model.heating_tau_s;
    const double convection =
        model.convection == 0.0
            ? 0.0
            : model.convection * std::pow(std::max(0.0, above_degC) / convection_degC, 0.25);
    return lacking_degC * (1.0 + convection) / model.cooling_tau_s;
}

WireState mounted_rate(const WireModel& model, double rise_degC, const WireState& x) {
    constexpr auto volumes = static_cast<double>(mount_nodes);
    const Mount& mount = model.mount;
    const double into_mount = mount.conductance_per_s * (x[0] - x[1]);
    WireState rate{};
    rate[0] = wire_rate(model, rise_degC, x[0]) - into_mount;
    rate[1] = into_mount * volumes / mount.capacity_ratio;
    for (std::size_t i = 1; i <= mount_nodes; ++i) {
        rate[i] -= (x[i] - model.ambient_degC) / mount.loss_s;
        if (i == mount_nodes) break;
        const double along = (x[i] - x[i + 1]) * volumes * volumes / mount.diffusion_s;
        rate[i] -= along;
        rate[i + 1] += along;
    }
    return rate;
}

}  // namespace

WireModel make_wire(const HeaterParameters& heater, const HeaterDepartures& departures) {
    return {.onset_V = heater.onset_V,
            .limit_V = heater.limit_V,
            .rise_degC_per_V = heater.gain_degC_per_V * departures.gain,
            .heating_tau_s = heater.heating_tau_s * departures.heating_tau,
            .cooling_tau_s = heater.cooling_tau_s * departures.cooling_tau,
            .ambient_degC = heater.ambient_degC + departures.ambient_degC,
            .curvature = departures.curvature,
            .convection = departures.convection,
            .cold_gain = departures.cold_gain,
            .mount = departures.mount};
}

WireState cold_wire(const WireModel& model) {
    WireState state;
    state.fill(model.ambient_degC);
    return state;
}

void advance(const WireModel& model, WireState& state, double command_V, double h_s) {
    const double above_V = std::min(command_V, model.limit_V) - model.onset_V;
    const double share = above_V / (model.limit_V - model.onset_V);
    const double rise_degC =
        model.rise_degC_per_V * std::max(above_V, 0.0) * (1.0 + model.curvature * (2.0 * share - 1.0));
    if (model.mount.conductance_per_s == 0.0) {
        const auto rate = [&](const std::array<double, 1>& temp) {
            return std::array{wire_rate(model, rise_degC, temp[0])};
        };
        state[0] = runge_kutta_step(std::array{state[0]}, h_s, rate)[0];
        return;
    }
    state =
        runge_kutta_step(state, h_s, [&](const WireState& x) { return mounted_rate(model, rise_degC, x); });
}

}  // namespace fidservo::reference
