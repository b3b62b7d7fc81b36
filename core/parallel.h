// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <functional>

namespace fidservo {

/// Calls work(0) ... work(count - 1) in any order, on the caller's core and on cores that are idle at the
/// time; `work` may itself call this function. Rethrows the first exception once all calls have ended.
void parallel_for(std::size_t count, const std::function<void(std::size_t)>& work);

/// Sets on how many cores all calls of parallel_for() together work, at least 1; initially on all of the
/// machine. Must not be called while a parallel_for() runs.
void use_cores(std::size_t count);

}  // namespace fidservo
