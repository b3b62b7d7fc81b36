// SPDX-License-Identifier: GPL-3.0-or-later
#include "control/macro_controller.h"

#include <cmath>
#include <cstdlib>

namespace fidservo::control {

double macro_update(const MacroControllerParams& params, MacroControllerState& state,
                    std::int64_t encoder_count) {
    state.command_V = 0.0;
    if (state.setpoint_count) {
        const double error_count = *state.setpoint_count - static_cast<double>(encoder_count);
        state.command_V = pd_update(params.pd, params.limit_V, state.pd, error_count);
    }
    const bool quiet = state.command_V == 0.0 && state.last_count == encoder_count;
    state.quiet_s = quiet ? state.quiet_s + params.tick_s : 0.0;
    state.last_count = encoder_count;
    ++state.steady_ticks;
    if (std::abs(encoder_count - state.steady_count) > 1) {
        state.steady_count = encoder_count;
        state.steady_ticks = 0;
    }
    return state.command_V;
}

void macro_go_to(MacroControllerState& state, double setpoint_count) {
    state.setpoint_count = std::round(setpoint_count);
    state.pd = {};
    state.quiet_s = 0.0;
    state.steady_ticks = 0;
}

bool macro_is_near(const MacroControllerState& state, int near_count) {
    constexpr int enough_ticks = 10;
    return state.setpoint_count && state.last_count && state.steady_ticks >= enough_ticks &&
           std::abs(*state.setpoint_count - static_cast<double>(*state.last_count)) <= near_count;
}

bool macro_is_quiet(const MacroControllerParams& params, const MacroControllerState& state) {
    return state.quiet_s >= params.quiet_s;
}

}  // namespace fidservo::control
