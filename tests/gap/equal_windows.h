// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Windows of one length, one after the other.
#include "gap/evidence.h"

#include <vector>

namespace fidservo::testing {

inline std::vector<gap::Window> equal_windows(std::size_t count, std::size_t values) {
    std::vector<gap::Window> all(count);
    for (std::size_t w = 0; w < count; ++w) {
        all[w].begin = w * values;
        all[w].end = all[w].begin + values;
    }
    return all;
}

}  // namespace fidservo::testing
