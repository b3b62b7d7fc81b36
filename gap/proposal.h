// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Proposes an equation: for the whole gap, in place of the named effects, or for what remains, in addition to
// them.
#include "gap/diagnose.h"
#include "gap/search/selection.h"

namespace fidservo::gap {

/// Where something remains unexplained and options.equation_s allows it, searches for an equation
/// (gap/equation/equation.h) in place of all named effects and for one in addition to them, and proposes the
/// more probable of the two (weight_of_first); the first only if it is more probable than the named effects
/// alone. The probabilities of effects that it replaces, and of the blocks that they accuse, are reduced
/// accordingly. Where the time ends before both were judged, the result until then is used.
/// @return how the search ended
Ended propose_equation(const Evidence& evidence, const Selection& selection, const DiagnosisOptions& options,
                       Diagnosis& diagnosis);

}  // namespace fidservo::gap
