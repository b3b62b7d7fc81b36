// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/v4l2/frame_time.h"

#include <gtest/gtest.h>

namespace fidservo::vision::v4l2 {
namespace {

constexpr TimeNs arrival_ns = 1'000 * ns_per_s;
constexpr FrameDelays delays{.exposure_s = 0.004, .latency_s = 0.030};

Stamp stamp(TimeNs time_ns, StampEvent event, StampClock clock = StampClock::monotonic) {
    return {time_ns, clock, event};
}

TEST(FrameTime, StartOfExposure_MiddleIsHalfAnExposureLater) {
    const Stamp start = stamp(arrival_ns - 20 * ns_per_ms, StampEvent::start_of_exposure);
    EXPECT_EQ(mid_exposure_ns(start, arrival_ns, delays), arrival_ns - 18 * ns_per_ms);
}

TEST(FrameTime, EndOfFrame_MiddleIsHalfAnExposureEarlier) {
    const Stamp end = stamp(arrival_ns - ns_per_ms, StampEvent::end_of_frame);
    EXPECT_EQ(mid_exposure_ns(end, arrival_ns, delays), arrival_ns - 3 * ns_per_ms);
}

TEST(FrameTime, ExtrapolatedStamp_IsNotAfterTheArrival) {
    const Stamp ahead = stamp(arrival_ns + ns_per_ms, StampEvent::start_of_exposure);
    EXPECT_EQ(mid_exposure_ns(ahead, arrival_ns, delays), arrival_ns);
}

TEST(FrameTime, OtherClock_ArrivalLessLatency) {
    const Stamp copied = stamp(arrival_ns - ns_per_ms, StampEvent::end_of_frame, StampClock::other);
    EXPECT_EQ(mid_exposure_ns(copied, arrival_ns, delays), arrival_ns - 30 * ns_per_ms);
}

TEST(FrameTime, StampOfAnotherClockThanItSays_IsFoundOut) {
    const auto usable = [](TimeNs time_ns) {
        return stamp_is_usable(stamp(time_ns, StampEvent::end_of_frame), arrival_ns);
    };
    EXPECT_TRUE(usable(arrival_ns));
    EXPECT_TRUE(usable(arrival_ns - 10 * ns_per_s));
    EXPECT_FALSE(usable(0));
    EXPECT_TRUE(usable(arrival_ns + 100 * ns_per_ms));
    EXPECT_FALSE(usable(arrival_ns + 100 * ns_per_ms + 1)) << "in the future";
    EXPECT_FALSE(usable(arrival_ns - 10 * ns_per_s - 1)) << "too old";
    EXPECT_FALSE(usable(1'700'000'000 * ns_per_s)) << "time of day";
}

}  // namespace
}  // namespace fidservo::vision::v4l2
