// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A wire and a second thermal mass (clamps, plates, mount) that takes heat from it and gives it back later:
//
//     dq/dt = (phi - q + s b) / tau - h e / tau_c (p q - b)        q, b: wire and mass above ambient, degC
//     tau_b db/dt = q - b,    b in units of what the wire brings it to at last
//     s = a max(0, 1 - l),  e = a - s,  p = max(1, l);  or, for a source, s = 0,  e = a,  p = l
//
// a: conductance from the mass to the wire over the wire's conductance to the room; l: heat that the mass
// takes over heat that it gives back. l = 1: the mass loses heat to the wire only; l > 1: to the room too; l
// < 1: part of it counts as the wire's surroundings, which warm without drawing heat from the wire, or, for a
// source, it gives the wire heat that it has not taken from it. tau is the heating time constant while phi >
// q - s b, else the cooling one, tau_c; h a factor on the conductance while heating. Both equations are
// linear within a regime and have real rates, so that a tick has a closed form:
//
//     y(t) = exp(m t) (cosh(d t) I + sinh(d t)/d (A - m I)) y(0),   m = tr A / 2,  d^2 = m^2 - det A,
//
// y the deviation from the equilibrium. Where the regime changes within a tick, the time of the change is
// found to rounding, and the rest of the tick has the other regime. Source: two lumped capacitances,
// Incropera, DeWitt, Fundamentals of Heat and Mass Transfer, 6th ed., 2007, ch. 5; matrix exponential of a 2
// x 2 matrix: Bernstein, So, IEEE Trans. Automatic Control 38(8), 1993.
#include "plant/thermal_regimes.h"

#include <Eigen/Core>

namespace fidservo::plant {

struct ThermalPair {
    double heating_tau_s;
    double cooling_tau_s;
    double coupling;       ///< a >= 0, less than 1 / (1 - l) where l < 1
    double mass_tau_s;     ///< tau_b > 0
    double taken = 1.0;    ///< l >= 0
    double heating = 1.0;  ///< h > 0
    bool is_source = false;

    /// s: the part of the mass's return that acts as warmer surroundings.
    double surrounding() const;
    /// p: the heat that the wire loses to the mass over the heat that the mass gives back.
    double drawn() const;
};

/// Wire and mass above ambient in degC after any time under a constant phi (degC).
Eigen::Vector2d advance(const ThermalPair& pair, const Eigen::Vector2d& rise_degC, double phi_degC,
                        double time_s);

/// The pair's constants for ticks of one length.
struct ThermalPairTick {
    double time_s;
    double surrounding;  ///< s
    ThermalRegime<2> heating, cooling;
};

ThermalPairTick thermal_pair_tick(const ThermalPair& pair, double time_s);

/// Wire and mass above ambient in degC after any time under a constant phi (degC).
Eigen::Vector2d advance(const ThermalPairTick& tick, const Eigen::Vector2d& rise_degC, double phi_degC,
                        double time_s);

/// Wire and mass above ambient in degC after a tick under a constant phi (degC).
Eigen::Vector2d advance(const ThermalPairTick& tick, const Eigen::Vector2d& rise_degC, double phi_degC);

}  // namespace fidservo::plant
