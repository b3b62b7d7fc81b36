// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A proposed equation compared with the formula that the case was made with.
#include "core/formula_effect.h"
#include "gap/diagnosis.h"

#include <optional>
#include <string>

namespace fidservo::selfcheck {

struct EquationScore {
    std::string acts_on, formula;  ///< empty: no equation was proposed
    bool right_variables = false;
    /// R.m.s. of the difference between proposed and true function over the data, relative to the r.m.s. of
    /// the true one. Both are converted to a common quantity: for the carriage a force against the motion,
    /// while it moves; for the wire a heating rate. Without a common quantity it is 1. For the encoder means
    /// are subtracted, since recordings do not determine the zero.
    double apart = 1.0;
    double removed = 0.0;  ///< fraction of the gap to be explained that it removes, on held-out recordings
    std::optional<double> removed_of_kinds_left_out = {};
};

/// Largest `apart` of a proposed function that counts as the right form.
inline constexpr double right_form = 0.05;

/// @param evidence  the diagnosed one
EquationScore score_equation(const FormulaEffect& truth, const gap::Diagnosis& diagnosis,
                             const gap::Evidence& evidence);

}  // namespace fidservo::selfcheck
