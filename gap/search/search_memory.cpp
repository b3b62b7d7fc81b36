// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/search/search_memory.h"

#include <algorithm>

namespace fidservo::gap {

Finding& SearchMemory::of(std::size_t candidate, const std::array<Hypothesis, 2>& beside) {
    std::deque<Finding>& known = findings_[candidate];
    const auto found = std::ranges::find(known, beside, &Finding::beside);
    if (found != known.end()) return *found;
    Finding& fresh = known.emplace_back();
    fresh.beside = beside;
    return fresh;
}

}  // namespace fidservo::gap
