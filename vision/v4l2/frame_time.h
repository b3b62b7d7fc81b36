// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The exposure time of a frame, from what the driver says about it.
#include "core/time.h"

#include <cstdint>

namespace fidservo::vision::v4l2 {

/// The clock of a driver's time stamp.
enum class StampClock {
    monotonic,  ///< CLOCK_MONOTONIC
    other,      ///< none, unknown, or copied from the program that feeds the device
};

/// The event that the time stamp belongs to.
enum class StampEvent {
    end_of_frame,       ///< the arrival of the frame's last byte
    start_of_exposure,  ///< the beginning of its exposure
};

struct Stamp {
    TimeNs time_ns = 0;
    StampClock clock = StampClock::other;
    StampEvent event = StampEvent::end_of_frame;
};

struct FrameDelays {
    double exposure_s = 0.0;
    double latency_s = 0.0;  ///< from the middle of the exposure to the arrival, for frames without a stamp
};

/// Whether a time stamp can be used: it must be of the monotonic clock, at most 10 s before the frame's
/// arrival and at most 0.1 s after it (as from drivers that extrapolate their stamps). This also detects
/// drivers that stamp with another clock than they state.
bool stamp_is_usable(const Stamp& stamp, TimeNs arrival_ns);

/// The middle of the exposure, ns on CLOCK_MONOTONIC.
///
///   start of exposure:  t = stamp + exposure / 2
///   end of frame:       t = stamp - exposure / 2
///   no usable stamp:    t = arrival - latency
///
/// It never lies after the arrival. No driver states the read-out time between the exposure and the end of
/// the frame; it remains as a constant delay, which homing measures against the stage.
TimeNs mid_exposure_ns(const Stamp& stamp, TimeNs arrival_ns, const FrameDelays& delays);

}  // namespace fidservo::vision::v4l2
