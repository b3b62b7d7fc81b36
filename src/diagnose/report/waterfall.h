// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How the gap shrinks as effects enter the explanation.
#include "gap/diagnosis.h"

#include <string>

namespace fidservo::diagnose {

/// The gap in floors after adding the effects of a diagnosis one by one, from the fractions that they remove:
///
///     after^2 = 1 + (1 - removed) (before^2 - 1),
///
/// The last value is the diagnosis's own `after`. One value for each effect.
std::vector<double> gap_after_steps(const gap::Diagnosis& diagnosis);

/// Bars on a logarithmic axis in floors, one row for each step; the floor is marked.
std::string waterfall_svg(const gap::Diagnosis& diagnosis);

}  // namespace fidservo::diagnose
