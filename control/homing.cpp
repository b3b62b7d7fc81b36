// SPDX-License-Identifier: GPL-3.0-or-later
#include "control/homing.h"

#include <cmath>

namespace fidservo::control {

double homing_update(const HomingParams& params, HomingState& state, std::int64_t encoder_count) {
    if (state.phase != HomingPhase::seeking) return macro_update(params.macro, state.macro, encoder_count);
    if (!state.started) {
        state.started = true;
        state.start_count = encoder_count;
    }
    const bool still = state.macro.last_count == encoder_count;
    state.still_s = still ? state.still_s + params.macro.tick_s : 0.0;
    state.ramp_count += params.speed_count_per_s * params.macro.tick_s;
    state.macro.setpoint_count = std::round(static_cast<double>(state.start_count) - state.ramp_count);
    const double error_count = static_cast<double>(encoder_count) - *state.macro.setpoint_count;
    if (error_count >= params.stuck_error_count && state.still_s >= params.stuck_s) {
        state.phase = HomingPhase::at_stop;
        state.stop_count = encoder_count;
        state.macro.setpoint_count.reset();
    } else if (state.ramp_count > params.longest_travel_count) {
        state.phase = HomingPhase::failed;
        state.macro.setpoint_count.reset();
    }
    return macro_update(params.macro, state.macro, encoder_count);
}

}  // namespace fidservo::control
