// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "gap/diagnosis.h"

#include <algorithm>
#include <string>
#include <vector>

namespace fidservo::testing {

/// The names of a diagnosis's effects in alphabetical order.
inline std::vector<std::string> names(const gap::Diagnosis& diagnosis) {
    std::vector<std::string> found;
    for (const gap::FoundEffect& effect : diagnosis.effects) found.push_back(effect.effect);
    std::ranges::sort(found);
    return found;
}

}  // namespace fidservo::testing
