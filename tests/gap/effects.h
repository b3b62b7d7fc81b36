// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "gap/evidence.h"
#include "plant/effects/catalogue.h"

#include <initializer_list>
#include <string_view>

namespace fidservo::testing {

inline gap::Hypothesis effects(std::initializer_list<std::string_view> texts) {
    gap::Hypothesis hypothesis;
    for (const std::string_view text : texts) hypothesis.push_back(plant::parse_effect(text));
    return hypothesis;
}

}  // namespace fidservo::testing
