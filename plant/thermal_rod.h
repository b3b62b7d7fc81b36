// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A wire whose second thermal mass (plant/thermal_pair.h) conducts heat within it, as a rod that the wire
// ends in: n equal parts, each as warm as its middle,
//
//     dq/dt = (phi - q + s b_1) / tau - h e / tau_c (p q - b_1)
//     db_i/dt = ((b_{i-1} - b_i) + (b_{i+1} - b_i)) n^2 / tau_d - b_i (p - 1) / (p tau_b)
//               (+ n / (p tau_b) (p q - b_1) for i = 1; no b_0, b_{n+1})
//
// tau_d: the rod's length^2 over its diffusivity. Where it is small all parts are as warm as each other, and
// the pair's equations hold for them. Within a regime the rates form a matrix that a scaling of the states
// makes symmetric: real rates, and exp(A t) by its eigenvectors. Source: Incropera, DeWitt, Fundamentals of
// Heat and Mass Transfer, 6th ed., 2007, ch. 5.10: finite differences.
#include "plant/thermal_pair.h"

#include <Eigen/Core>

namespace fidservo::plant {

inline constexpr int rod_parts = 3;

/// Wire, then the rod's parts from the wire on, above ambient in degC; those in the units of the pair's mass.
using RodRise = Eigen::Matrix<double, 1 + rod_parts, 1>;

/// One regime, with the eigenvectors of its rates.
struct RodRegime : ThermalRegime<1 + rod_parts> {
    Rise decays_per_s;
    Matrix ways, to_ways;  ///< eigenvectors, and their inverse
};

/// What follows from a rod's parameters for a tick.
struct ThermalRod {
    double tick_s;
    double surrounding;  ///< s
    RodRegime heating, cooling;
};

/// @param pair  of coupling > 0
/// @param diffusion_s  tau_d > 0
ThermalRod thermal_rod(const ThermalPair& pair, double diffusion_s, double tick_s);

/// After a time under a constant phi (degC), however long.
RodRise advance(const ThermalRod& rod, const RodRise& rise_degC, double phi_degC, double time_s);

/// After a tick.
RodRise advance(const ThermalRod& rod, const RodRise& rise_degC, double phi_degC);

}  // namespace fidservo::plant
