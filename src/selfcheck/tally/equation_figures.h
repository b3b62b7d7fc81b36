// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What outcomes come to of equations that are proposed for what no name is right for.
#include "src/selfcheck/tally/tally.h"

#include <span>
#include <vector>

namespace fidservo::selfcheck {

/// From this size on, in floors (Score::floors), an equation is asked for.
inline constexpr double equation_floors = 10.0;

/// Of effects withheld or not listed that a formula at a port states (draw/true_formula.h).
std::vector<ShareFigure> equation_shares(std::span<const Outcome> outcomes);

std::vector<LimitFigure> equation_limits(std::span<const Outcome> outcomes);

}  // namespace fidservo::selfcheck
