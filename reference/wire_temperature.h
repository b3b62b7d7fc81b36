// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The wire's temperature, by integration of
//
//     dT/dt = (phi(c) - (T - Ta)) / tau - k (T - R_1),     tau by whether phi > T - Ta
//
// phi is the steady temperature rise under the heater driver's voltage c. Free convection divides the tau of
// cooling by 1 + q ((T - Ta) / 60)^(1/4); a gain of the cold wire multiplies phi by 1 + g (1 - (T - Ta) /
// 200), in degC. R_1..R_n are the temperatures of the mount: a rod in n equal volumes that conducts along and
// loses heat to the room,
//
//     dR_i/dt = (R_{i-1} - 2 R_i + R_{i+1}) n^2 / tau_d - (R_i - Ta) / tau_l  (+ k (T - R_1) n / C for i = 1)
#include "core/micro_parameters.h"
#include "reference/departures.h"

#include <array>
#include <cstddef>

namespace fidservo::reference {

inline constexpr std::size_t mount_nodes = 6;

struct WireModel {
    double onset_V, limit_V;
    double rise_degC_per_V;
    double heating_tau_s, cooling_tau_s;
    double ambient_degC;
    double curvature = 0.0;
    double convection = 0.0;
    double cold_gain = 0.0;
    Mount mount;
};

/// The wire's temperature, then the mount's from the near end to the far end, degC.
using WireState = std::array<double, 1 + mount_nodes>;

WireModel make_wire(const HeaterParameters& heater, const HeaterDepartures& departures);

/// Wire and mount at room temperature.
WireState cold_wire(const WireModel& model);

/// Moves the temperatures on for h_s seconds under a held command in V.
void advance(const WireModel& model, WireState& state, double command_V, double h_s);

}  // namespace fidservo::reference
