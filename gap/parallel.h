#pragma once
#include <cstddef>
#include <functional>

namespace fidservo::gap {

/// Calls work(0) ... work(count - 1) on all cores, in any order. The first exception is thrown again once all
/// have ended.
void parallel_for(std::size_t count, const std::function<void(std::size_t)>& work);

}  // namespace fidservo::gap
