// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A proposed equation compared with the formula that the case was made with.
#include "core/formula_effect.h"
#include "gap/diagnosis.h"

#include <optional>
#include <string>

namespace fidservo::selfcheck {

struct EquationScore {
    std::string acts_on, formula;  ///< empty: none was proposed
    bool right_variables = false;
    /// R.m.s. of the difference of both functions over the data, over that of the true one. Both are told in
    /// what they have in common: forces on the carriage as such against motion, while it moves; heat as a
    /// rate. Where they have nothing in common it is 1. Of the encoder without means, since recordings tell
    /// no zero.
    double apart = 1.0;
    double removed = 0.0;  ///< of the gap that it is looked for in, on held-out recordings
    std::optional<double> removed_of_kinds_left_out = {};
};

/// From here on a proposed function is of the right form.
inline constexpr double right_form = 0.05;

/// @param evidence  that was diagnosed
EquationScore score_equation(const FormulaEffect& truth, const gap::Diagnosis& diagnosis,
                             const gap::Evidence& evidence);

}  // namespace fidservo::selfcheck
