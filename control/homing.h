#pragma once
// Finding the end stop. The encoder is incremental: nothing is known of the position before. The carriage
// follows a slow ramp towards the low end of travel; where it stands although the ramp goes on is the stop.
#include "control/macro_controller.h"

#include <cstdint>

namespace fidservo::control {

struct HomingParams {
    MacroControllerParams macro;
    double speed_count_per_s = 600.0;  ///< of the ramp (30 mm/s at 50 um)
    double stuck_error_count = 60.0;   ///< ramp ahead of the carriage by this much...
    double stuck_s = 0.100;            ///< ...without a count for this long
    double longest_travel_count = 4400.0;
};

enum class HomingPhase : std::uint8_t { seeking, at_stop, failed };

struct HomingState {
    HomingPhase phase = HomingPhase::seeking;
    MacroControllerState macro;
    double ramp_count = 0.0;  ///< how far the ramp has gone
    std::int64_t start_count = 0;
    std::int64_t stop_count = 0;  ///< the reading at the end stop, once found
    double still_s = 0.0;
    bool started = false;
};

/// One tick. @return the macro command in V; zero once the stop is found or the travel is exceeded.
double homing_update(const HomingParams& params, HomingState& state, std::int64_t encoder_count);

}  // namespace fidservo::control
