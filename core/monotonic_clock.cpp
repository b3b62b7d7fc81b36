// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/monotonic_clock.h"

#include <ctime>

namespace fidservo {

TimeNs monotonic_now_ns() {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec * ns_per_s + now.tv_nsec;
}

}  // namespace fidservo
