#pragma once
// A wire and a second thermal mass (clamps, plates, mount) that takes heat from it and gives it back later:
//
//     dq/dt = (phi - q) / tau - a / tau_c (q - b)          q, b: wire and mass above ambient, degC
//     tau_b db/dt = r q - b
//
// tau_c: the cooling time constant; a: conductance from the wire to the mass per conductance to the room; r:
// the mass's steady rise per rise of the wire. tau is the heating time constant while phi > q, else the
// cooling one. Both equations are linear within a regime and have real rates, so that a tick has a closed
// form:
//
//     y(t) = exp(m t) (cosh(d t) I + sinh(d t)/d (A - m I)) y(0),   m = tr A / 2,  d^2 = m^2 - det A,
//
// y the deviation from the equilibrium. Where the wire comes to phi within a tick, the time is found to
// rounding, and what is left of the tick has the other regime. Source: two lumped capacitances, Incropera,
// DeWitt, Fundamentals of Heat and Mass Transfer, 6th ed., 2007, ch. 5; matrix exponential of a 2 x 2 matrix:
// Bernstein, So, IEEE Trans. Automatic Control 38(8), 1993.
#include <Eigen/Core>

namespace fidservo::plant {

struct ThermalPair {
    double heating_tau_s;
    double cooling_tau_s;
    double coupling;    ///< a >= 0
    double mass_tau_s;  ///< tau_b > 0
    double retention;   ///< r, 0 .. 1
};

/// Wire and mass above ambient in degC after a time under a constant phi (degC), however long.
Eigen::Vector2d advance(const ThermalPair& pair, const Eigen::Vector2d& rise_degC, double phi_degC,
                        double time_s);

/// A pair over ticks of one length, what decays in one of them computed once.
struct ThermalPairTick {
    ThermalPair pair;
    double time_s;
    Eigen::Matrix2d heating_decay, cooling_decay;  ///< y(time_s) = decay y(0), by regime
};

ThermalPairTick thermal_pair_tick(const ThermalPair& pair, double time_s);

/// Wire and mass above ambient in degC after a tick under a constant phi (degC).
Eigen::Vector2d advance(const ThermalPairTick& tick, const Eigen::Vector2d& rise_degC, double phi_degC);

}  // namespace fidservo::plant
