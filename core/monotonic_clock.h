#pragma once
#include "core/time.h"

namespace fidservo {

/// Now, ns on CLOCK_MONOTONIC.
TimeNs monotonic_now_ns();

}  // namespace fidservo
