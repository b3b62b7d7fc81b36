// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A wire whose second thermal mass (plant/thermal_pair.h) conducts heat within itself: a rod at the wire's
// end, in n equal parts of uniform temperature,
//
//     dq/dt = (phi - q + s b_1) / tau - h e / tau_c (p q - b_1)
//     db_i/dt = ((b_{i-1} - b_i) + (b_{i+1} - b_i)) n^2 / tau_d - b_i (p - 1) / (p tau_b)
//               (+ n / (p tau_b) (p q - b_1) for i = 1; no b_0, b_{n+1})
//
// tau_d: the rod's length^2 over its diffusivity. Where tau_d is small all parts have the same temperature,
// and the pair's equations hold. Within a regime the rates form a matrix that a scaling of the states makes
// symmetric: so its eigenvalues are real, and exp(A t) follows from its eigenvectors. Source: Incropera,
// DeWitt, Fundamentals of Heat and Mass Transfer, 6th ed., 2007, ch. 5.10: finite differences.
#include "plant/thermal_pair.h"

#include <Eigen/Core>

namespace fidservo::plant {

inline constexpr int rod_parts = 3;

/// Temperatures above ambient in degC: the wire's, then the rod's parts from the wire on; the latter in units
/// of the pair's mass.
using RodRise = Eigen::Matrix<double, 1 + rod_parts, 1>;

/// One regime, with the eigenvalues and eigenvectors of its rates.
struct RodRegime : ThermalRegime<1 + rod_parts> {
    Rise decays_per_s;
    Matrix ways, to_ways;  ///< eigenvectors, and their inverse
};

/// Constants of a rod for ticks of one length.
struct ThermalRod {
    double tick_s;
    double surrounding;  ///< s
    RodRegime heating, cooling;
};

/// @param pair  with coupling > 0
/// @param diffusion_s  tau_d > 0
ThermalRod thermal_rod(const ThermalPair& pair, double diffusion_s, double tick_s);

/// The temperatures after any time under a constant phi (degC).
RodRise advance(const ThermalRod& rod, const RodRise& rise_degC, double phi_degC, double time_s);

/// The temperatures after a tick under a constant phi (degC).
RodRise advance(const ThermalRod& rod, const RodRise& rise_degC, double phi_degC);

}  // namespace fidservo::plant
