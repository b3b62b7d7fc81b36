// SPDX-License-Identifier: GPL-3.0-or-later
#include "control/nonlinear_pd.h"

#include "core/macro_parameters.h"

#include <algorithm>
#include <cmath>

namespace fidservo::control {

double pd_update(const PdGains& gains, double limit_V, PdState& state, double error_count) {
    const double u = gains.e0_V_per_count * error_count + gains.e1_V_per_count * state.last_error_count;
    state.last_error_count = error_count;
    if (u == 0.0) return 0.0;
    return std::clamp(u + std::copysign(gains.friction_V, u), -limit_V, limit_V);
}

double pid_update(const PidGains& gains, double limit_V, double tick_s, PidState& state, double error_count) {
    state.integral_V =
        std::clamp(state.integral_V + gains.ki_V_per_count_s * tick_s * error_count, -limit_V, limit_V);
    const double u = gains.kp_V_per_count * error_count + state.integral_V +
                     gains.kd_V_s_per_count * (error_count - state.last_error_count) / tick_s;
    state.last_error_count = error_count;
    return std::clamp(u, -limit_V, limit_V);
}

}  // namespace fidservo::control
