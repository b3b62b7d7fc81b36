// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Whether a carriage that somebody else's commands move stays on its travel.
#include <optional>

namespace fidservo {

struct Rig;

/// With the motor off the carriage coasts to rest over speed times its velocity time constant.
struct TravelWatch {
    double low_mm, high_mm;  ///< where it may come to rest
    double coast_s;
    double tick_s;
};

/// That of a rig's travel, but for half a millimetre at either end.
TravelWatch travel_watch(const Rig& rig);

struct TravelWatchState {
    std::optional<double> last_mm;
    double speed_mm_per_s = 0.0;  ///< low-pass over ten ticks
};

/// One tick. @return whether the carriage, if the motor were switched off now, would come to rest beyond
bool leaves_travel(const TravelWatch& watch, TravelWatchState& state, double carriage_mm);

}  // namespace fidservo
