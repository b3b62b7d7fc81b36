// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "core/time.h"

namespace fidservo {

/// Now, ns on CLOCK_MONOTONIC.
TimeNs monotonic_now_ns();

}  // namespace fidservo
