// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The micro stage's inner loop: a PI controller with anti-windup.
#include "core/micro_parameters.h"

namespace fidservo::control {

/// What a PI remembers from tick to tick.
struct PiState {
    double integral_V;  ///< integral term of the command
};

/// The initial state of the published controller: the integrator is at the heater's onset.
inline PiState pi_start(const PiGains& gains) {
    return {gains.low_V};
}

/// PI with back-calculation anti-windup; e in mm, output in V:
///     w = feedforward + kp e + I;   c = clamp(w, low, high);   I += T (ki e + kaw (c - w))
/// Without feedforward this is the published controller.
double pi_update(const PiGains& gains, double tick_s, PiState& state, double error_mm,
                 double feedforward_V = 0.0);

}  // namespace fidservo::control
