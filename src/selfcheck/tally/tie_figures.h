// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "src/selfcheck/tally/tally.h"

#include <span>
#include <vector>

namespace fidservo::selfcheck {

/// Of the ties for which an experiment was designed (src/selfcheck/ties.h): resolved by it, and by the best
/// one of the list.
std::vector<ShareFigure> tie_shares(std::span<const Outcome> outcomes);

}  // namespace fidservo::selfcheck
