// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The macro stage under the nonlinear PD controller, with a setpoint in encoder counts, and whether the
// carriage is at rest as far as the encoder shows.
#include "control/nonlinear_pd.h"

#include <cstdint>
#include <optional>

namespace fidservo::control {

/// Parameters of the macro stage's controller.
struct MacroControllerParams {
    PdGains pd;      ///< gains of the nonlinear PD
    double limit_V;  ///< largest command in either direction
    double tick_s;   ///< time between ticks
    /// The carriage is quiet after this long without a command and without a change of count: several
    /// velocity time constants.
    double quiet_s = 0.150;
};

/// All that the controller remembers from tick to tick.
struct MacroControllerState {
    std::optional<double> setpoint_count;    ///< empty: the motor is off
    PdState pd;                              ///< state of the nonlinear PD
    std::optional<std::int64_t> last_count;  ///< the reading of the tick before; empty at first
    double quiet_s = 0.0;                    ///< time since the last command or change of count
    std::int64_t steady_count = 0;  ///< the reading that those of steady_ticks stay within a count of
    int steady_ticks = 0;    ///< number of ticks for which readings have been within a count of steady_count
    double command_V = 0.0;  ///< the last command
};

/// One tick. @return the command in V
double macro_update(const MacroControllerParams& params, MacroControllerState& state,
                    std::int64_t encoder_count);

/// Sets a setpoint, rounded to a count, for a carriage at rest.
void macro_go_to(MacroControllerState& state, double setpoint_count);

/// Whether the carriage is within `near_count` of its setpoint and has stayed within a count for some ticks,
/// whatever is commanded. Where commands or readings come late, the PD may go on with small pulses for ever:
/// macro_is_quiet() then never holds.
bool macro_is_near(const MacroControllerState& state, int near_count);

/// Whether the carriage stands, as far as encoder and command tell. The encoder shows nothing less than a
/// count, so a camera must confirm it.
bool macro_is_quiet(const MacroControllerParams& params, const MacroControllerState& state);

}  // namespace fidservo::control
