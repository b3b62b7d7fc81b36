// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <functional>

namespace fidservo {

/// Calls work(0) ... work(count - 1) in any order, on the caller's core and those that are idle then: work
/// may call it again. The first exception is thrown again once all have ended.
void parallel_for(std::size_t count, const std::function<void(std::size_t)>& work);

/// On how many cores of the machine all calls together work from now on, at least 1; at first on all. To be
/// called while none is under way.
void use_cores(std::size_t count);

}  // namespace fidservo
