// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <ctime>

namespace fidservo {

/// Time that this thread, or whatever the clock measures, was running on a core; other programs' load does
/// not count.
inline double core_time_s(clockid_t clock = CLOCK_THREAD_CPUTIME_ID) {
    timespec time{};
    ::clock_gettime(clock, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace fidservo
