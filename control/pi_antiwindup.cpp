// SPDX-License-Identifier: GPL-3.0-or-later
#include "control/pi_antiwindup.h"

#include "core/micro_parameters.h"

#include <algorithm>

namespace fidservo::control {

double pi_update(const PiGains& gains, double tick_s, PiState& state, double error_mm, double feedforward_V) {
    const double wanted_V = feedforward_V + gains.kp_V_per_mm * error_mm + state.integral_V;
    const double command_V = std::clamp(wanted_V, gains.low_V, gains.high_V);
    state.integral_V += tick_s * (gains.ki_V_per_mm_s * error_mm + gains.kaw_per_s * (command_V - wanted_V));
    return command_V;
}

}  // namespace fidservo::control
