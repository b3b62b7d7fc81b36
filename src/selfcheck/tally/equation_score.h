// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A comparison of the equation that a diagnosis proposes with the true formula of its case.
#include "core/formula_effect.h"
#include "gap/diagnosis.h"

#include <optional>
#include <string>

namespace fidservo::selfcheck {

struct EquationScore {
    std::string acts_on, formula;  ///< empty: no equation was proposed
    bool right_variables = false;
    /// R.m.s. difference between the proposed and the true function over the data, relative to the r.m.s. of
    /// the true function. Both are converted to a common quantity: for the carriage a force against the
    /// motion, while it moves; for the wire a heating rate. Without a common quantity it is 1. For the
    /// encoder the means of both functions are subtracted first, since recordings do not determine the
    /// encoder's zero.
    double apart = 1.0;
    double removed = 0.0;  ///< fraction of the gap to be explained that it removes, on held-out recordings
    std::optional<double> removed_of_kinds_left_out = {};
};

/// A proposed function counts as having the right form up to this value of EquationScore::apart.
inline constexpr double right_form = 0.05;

/// @param evidence  the evidence that was diagnosed
EquationScore score_equation(const FormulaEffect& truth, const gap::Diagnosis& diagnosis,
                             const gap::Evidence& evidence);

}  // namespace fidservo::selfcheck
