// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/v4l2/frame_time.h"

#include <algorithm>

namespace fidservo::vision::v4l2 {

bool stamp_is_usable(const Stamp& stamp, TimeNs arrival_ns) {
    constexpr TimeNs oldest_ns = 10 * ns_per_s, ahead_ns = 100 * ns_per_ms;
    return stamp.clock == StampClock::monotonic && stamp.time_ns > 0 &&
           stamp.time_ns <= arrival_ns + ahead_ns && arrival_ns - stamp.time_ns <= oldest_ns;
}

TimeNs mid_exposure_ns(const Stamp& stamp, TimeNs arrival_ns, const FrameDelays& delays) {
    if (!stamp_is_usable(stamp, arrival_ns)) return arrival_ns - nanoseconds(delays.latency_s);
    const TimeNs half_ns = nanoseconds(0.5 * delays.exposure_s);
    const bool start = stamp.event == StampEvent::start_of_exposure;
    return std::min(arrival_ns, stamp.time_ns + (start ? half_ns : -half_ns));
}

}  // namespace fidservo::vision::v4l2
