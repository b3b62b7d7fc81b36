// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The micro stage of a rig file (assets/rig.yaml), checked, in memory. docs/notation.md states the equations.
#include "core/hall.h"
#include "core/preisach.h"

#include <memory>
#include <optional>

namespace fidservo {

/// The wire's heater, as the top of plant/heater.h uses it.
struct HeaterParameters {
    double onset_V;          ///< command below which the wire is not heated
    double limit_V;          ///< largest command
    double gain_degC_per_V;  ///< steady rise of temperature per volt beyond the onset
    double heating_tau_s;    ///< time constant while the wire warms
    double cooling_tau_s;    ///< time constant while it cools
    double ambient_degC;     ///< temperature of the room
};

/// The PI controller with anti-windup: w = kp e + I,  c = clamp(w, low, high),  I += T (ki e + kaw (c - w)),
/// e in mm.
struct PiGains {
    double kp_V_per_mm;    ///< gain of the error
    double ki_V_per_mm_s;  ///< gain of the error's integral
    double kaw_per_s;      ///< rate of back-calculation: how fast the integral gives way at the limits
    double low_V;          ///< smallest command
    double high_V;         ///< largest command
};

/// The micro stage as its rig file describes it.
struct MicroParameters {
    double low_mm;                        ///< lower end of the travel
    double high_mm;                       ///< upper end of the travel
    HeaterParameters heater;              ///< of the wire
    std::shared_ptr<const FodTable> fod;  ///< the wire's hysteresis
    HallParameters hall;                  ///< the platform's sensor
    std::optional<PiGains> pi;            ///< empty: the rig has no such controller
};

}  // namespace fidservo
