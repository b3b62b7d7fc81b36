// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/diagnosis.h"

#include <array>

namespace fidservo::gap {

std::string_view name_of(Verdict verdict) {
    constexpr std::array<std::string_view, 4> names{"no-gap", "explained", "partly-explained", "unexplained"};
    return names.at(static_cast<std::size_t>(verdict));
}

bool is_gap_left(Verdict verdict) {
    return verdict == Verdict::partly_explained || verdict == Verdict::unexplained;
}

const Equation* proposed_equation(const Diagnosis& diagnosis) {
    const bool is_there = diagnosis.unexplained && diagnosis.unexplained->equation;
    return is_there ? &*diagnosis.unexplained->equation : nullptr;
}

}  // namespace fidservo::gap
