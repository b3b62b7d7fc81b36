// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The macro stage's PD and PID controllers: the error e in counts, the command in V, saturated to the board's
// range.
#include "core/macro_parameters.h"

namespace fidservo::control {

/// State of the PD. A run starts at rest, with e[-1] = 0.
struct PdState {
    double last_error_count = 0.0;  ///< error of the tick before
};

/// PD with dead-zone inverse (publication, eq. 9 with the minus sign):
///     u = e0 e[k] + e1 e[k-1];   u' = u + friction sgn(u), 0 at u = 0
/// @return the command in V within +-limit_V
double pd_update(const PdGains& gains, double limit_V, PdState& state, double error_count);

/// What a PID remembers from tick to tick.
struct PidState {
    double integral_V = 0.0;        ///< integral term of the command
    double last_error_count = 0.0;  ///< error of the tick before
};

/// The benchmark PID, without friction compensation; the integral is not increased further at the command's
/// limit.
///     u = kp e + ki T sum(e) + kd (e[k] - e[k-1]) / T
double pid_update(const PidGains& gains, double limit_V, double tick_s, PidState& state, double error_count);

}  // namespace fidservo::control
