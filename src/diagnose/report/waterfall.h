// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How the gap shrinks as effects enter the explanation.
#include "gap/diagnosis.h"

#include <string>

namespace fidservo::diagnose {

/// The gap in floors with the first effects of a diagnosis: from the shares that they remove,
///
///     after^2 = 1 + (1 - removed) (before^2 - 1),
///
/// with all of them the diagnosis's own gap after. One value for each effect.
std::vector<double> gap_after_steps(const gap::Diagnosis& diagnosis);

/// Bars on a logarithmic axis in floors, the floor marked, one row a step.
std::string waterfall_svg(const gap::Diagnosis& diagnosis);

}  // namespace fidservo::diagnose
