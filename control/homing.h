// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Finding the end stop. The encoder is incremental: at power-up the position is unknown. The carriage follows
// a slow ramp of the setpoint towards the low end of travel; where it stands although the ramp goes on is the
// stop.
#include "control/macro_controller.h"

#include <cstdint>

namespace fidservo::control {

/// What a rig's homing needs.
struct HomingParams {
    MacroControllerParams macro;       ///< the controller that follows the ramp
    double speed_count_per_s = 600.0;  ///< speed of the ramp, counts per second (30 mm/s at 50 um per count)
    /// The stop is found where the ramp is ahead of the carriage by this much...
    double stuck_error_count = 60.0;
    double stuck_s = 0.100;                ///< ...and the count has not changed for this long
    double longest_travel_count = 4400.0;  ///< no stop within this distance: homing has failed
};

/// The phase of a homing.
enum class HomingPhase : std::uint8_t {
    seeking,  ///< the ramp goes on, the stop is not found yet
    at_stop,  ///< the stop is found
    failed,   ///< there is no stop within the longest travel
};

/// All that homing remembers from tick to tick.
struct HomingState {
    HomingPhase phase = HomingPhase::seeking;  ///< the phase
    MacroControllerState macro;                ///< state of the controller that follows the ramp
    double ramp_count = 0.0;                   ///< how far the ramp has gone
    std::int64_t start_count = 0;              ///< the encoder's reading at the beginning
    std::int64_t stop_count = 0;               ///< the encoder's reading at the end stop, once found
    double still_s = 0.0;                      ///< how long the count has not changed
    bool started = false;                      ///< whether the first reading has come
};

/// One tick. @return the macro command in V; zero once the stop is found or the travel is exceeded.
double homing_update(const HomingParams& params, HomingState& state, std::int64_t encoder_count);

}  // namespace fidservo::control
