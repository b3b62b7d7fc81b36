// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Whether the likelihood of a macro stage's parameters has more than one minimum.
#include "calib/macro/macro_fit.h"

#include <vector>

namespace fidservo::calib {

/// A minimum of the loss, and its height above the minimum of the fit (negative: below it).
struct MacroMinimum {
    MacroPoint point;
    double above;
};

/// The other minima that are found by searches from time constants between a tick and the recordings' length,
/// with and without friction. A minimum counts if a parameter differs from the fit by more than a fifth of
/// its size and four standard errors. The searches use at most 60 windows spread over the recordings; their
/// results are then refined on all windows.
std::vector<MacroMinimum> other_minima(const MacroEstimator& estimator, const MacroFit& fit);

}  // namespace fidservo::calib
