// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The macro stage as its sensors allow: the nonlinear PD to a setpoint in counts, and whether it stands
// still.
#include "control/nonlinear_pd.h"

#include <cstdint>
#include <optional>

namespace fidservo::control {

/// A macro stage under its controller.
struct MacroControllerParams {
    PdGains pd;              ///< gains of the nonlinear PD
    double limit_V;          ///< largest command
    double tick_s;           ///< time between ticks
    double quiet_s = 0.150;  ///< without command and without a count: several velocity time constants
};

/// All that the controller remembers from tick to tick.
struct MacroControllerState {
    std::optional<double> setpoint_count;    ///< without one the motor is off
    PdState pd;                              ///< of the nonlinear PD
    std::optional<std::int64_t> last_count;  ///< the reading before; empty at first
    double quiet_s = 0.0;                    ///< since the last command or count
    std::int64_t steady_count = 0;           ///< the reading that steady_ticks counts from
    int steady_ticks = 0;                    ///< for which readings have been within a count of steady_count
    double command_V = 0.0;                  ///< the last one
};

/// One tick. @return the command in V
double macro_update(const MacroControllerParams& params, MacroControllerState& state,
                    std::int64_t encoder_count);

/// Goes to a count (rounded), from rest.
void macro_go_to(MacroControllerState& state, double setpoint_count);

/// Whether it is within `near_count` of its setpoint and for some ticks within a count of where it is: slow,
/// whatever is commanded. The PD's last nudges may go on for ever where commands or readings come late.
bool macro_is_near(const MacroControllerState& state, int near_count);

/// The carriage stands, as far as the encoder and the command tell: it sees no less than a count, so a camera
/// must confirm it.
bool macro_is_quiet(const MacroControllerParams& params, const MacroControllerState& state);

}  // namespace fidservo::control
