#pragma once
// The micro stage of a rig file (assets/rig.yaml), checked, in memory. docs/notation.md states the equations.
#include "core/hall.h"
#include "core/preisach.h"

#include <memory>
#include <optional>

namespace fidservo {

struct HeaterParameters {
    double onset_V;
    double limit_V;
    double gain_degC_per_V;
    double heating_tau_s;
    double cooling_tau_s;
    double ambient_degC;
};

/// w = kp e + I,  c = clamp(w, low, high),  I += T (ki e + kaw (c - w)),  e in mm.
struct PiGains {
    double kp_V_per_mm;
    double ki_V_per_mm_s;
    double kaw_per_s;
    double low_V;
    double high_V;
};

struct MicroParameters {
    double low_mm;  ///< travel
    double high_mm;
    HeaterParameters heater;
    std::shared_ptr<const FodTable> fod;
    HallParameters hall;
    std::optional<PiGains> pi;
};

}  // namespace fidservo
