// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The equation of a diagnosis: for the whole gap in the place of its names, or beside them.
#include "gap/diagnose.h"
#include "gap/search/selection.h"

namespace fidservo::gap {

/// Where something is left and options.equation_s allows it, looks for an equation (gap/equation/equation.h)
/// in the place of all names and for one beside them, and proposes the likelier one of both
/// (weight_of_first), in the place of the names only where it is likelier than they alone. Of names in whose
/// place it stands, and of the blocks that they accuse, the probabilities are what that leaves them. Where
/// the time ends before both were judged, what was found by then counts.
/// @return how the time for it ended
Ended propose_equation(const Evidence& evidence, const Selection& selection, const DiagnosisOptions& options,
                       Diagnosis& diagnosis);

}  // namespace fidservo::gap
