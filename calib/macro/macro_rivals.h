// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Whether the likelihood of a macro stage's parameters has more than one minimum.
#include "calib/macro/macro_fit.h"

#include <vector>

namespace fidservo::calib {

/// A minimum of the loss and how far it lies above that of the fit (below, if negative).
struct MacroMinimum {
    MacroPoint point;
    double above;
};

/// The minima that searches from time constants between a tick and the recordings' length, with friction and
/// without, end in, and that differ from the fit: a parameter by more than a fifth of its size and four
/// standard errors. Searched on at most 60 windows spread over the recordings, then followed on all.
std::vector<MacroMinimum> other_minima(const MacroEstimator& estimator, const MacroFit& fit);

}  // namespace fidservo::calib
