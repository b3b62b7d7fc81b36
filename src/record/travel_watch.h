// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Whether a carriage under arbitrary commands will stay within its travel.
#include <optional>

namespace fidservo {

struct Rig;

/// Limits for the carriage. With the motor off it coasts by speed times its velocity time constant.
struct TravelWatch {
    double low_mm, high_mm;  ///< range in which it may come to rest
    double coast_s;
    double tick_s;
};

/// The limits for a rig: its travel less half a millimetre at either end.
TravelWatch travel_watch(const Rig& rig);

struct TravelWatchState {
    std::optional<double> last_mm;
    double speed_mm_per_s = 0.0;  ///< low-pass filtered over ten ticks
};

/// One tick. @return whether the carriage, if the motor were switched off now, would come to rest beyond
bool leaves_travel(const TravelWatch& watch, TravelWatchState& state, double carriage_mm);

}  // namespace fidservo
