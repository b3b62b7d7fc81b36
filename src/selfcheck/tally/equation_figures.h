// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Statistics of the equations proposed in cases where no name is right.
#include "src/selfcheck/tally/tally.h"

#include <span>
#include <vector>

namespace fidservo::selfcheck {

/// Least size, in floors (Score::floors), at which an equation is expected.
inline constexpr double equation_floors = 10.0;

/// Figures over the cases whose effect was withheld or is not in the catalogue, and can be stated as a
/// formula at a port (draw/true_formula.h).
std::vector<ShareFigure> equation_shares(std::span<const Outcome> outcomes);

std::vector<LimitFigure> equation_limits(std::span<const Outcome> outcomes);

}  // namespace fidservo::selfcheck
