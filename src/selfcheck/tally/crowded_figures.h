// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What outcomes of rigs with many causes at once come to.
#include "src/selfcheck/tally/tally.h"

#include <span>
#include <vector>

namespace fidservo::selfcheck {

/// Of three effects, those cases count in which each is by its size at judged_floors or more.
std::vector<ShareFigure> crowded_shares(std::span<const Outcome> outcomes);

std::vector<LimitFigure> crowded_limits(std::span<const Outcome> outcomes);

}  // namespace fidservo::selfcheck
