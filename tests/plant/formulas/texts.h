// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Formula effects for tests.
#include "core/formula_effect.h"

#include <string>
#include <utility>
#include <vector>

namespace fidservo::plant {

/// A parameter and its typical value, which acts; or a shape with its value.
struct Number {
    std::string name;
    double value;
    std::string role = "size";
};

/// @param numbers  the effect's parameters, with wide bounds
inline FormulaEffect formula_text(std::string acts_on, std::string block, std::string formula,
                                  const std::vector<Number>& numbers) {
    FormulaEffect text;
    text.name = "of_test";
    text.acts_on = std::move(acts_on);
    text.block = std::move(block);
    text.formula = std::move(formula);
    for (const Number& number : numbers)
        text.parameters.push_back({.name = number.name,
                                   .low = -1e4,
                                   .high = 1e4,
                                   .vanishing = number.role == "size" ? 0.0 : number.value,
                                   .typical = number.value,
                                   .role = number.role});
    return text;
}

}  // namespace fidservo::plant
