// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Time is a count of nanoseconds on one monotonic clock. A frame's time is the middle of its exposure.
#include <cstdint>

namespace fidservo {

/// A time or a duration, ns.
using TimeNs = std::int64_t;

/// Nanoseconds in a second.
inline constexpr TimeNs ns_per_s = 1'000'000'000;
/// Nanoseconds in a millisecond.
inline constexpr TimeNs ns_per_ms = 1'000'000;

/// A duration in s.
constexpr double seconds(TimeNs t_ns) {
    return static_cast<double>(t_ns) * 1e-9;
}

/// A duration in us.
constexpr double microseconds(TimeNs t_ns) {
    return 1e-3 * static_cast<double>(t_ns);
}

/// Nearest nanosecond to a duration in seconds.
constexpr TimeNs nanoseconds(double t_s) {
    return static_cast<TimeNs>(t_s * 1e9 + (t_s < 0 ? -0.5 : 0.5));
}

}  // namespace fidservo
