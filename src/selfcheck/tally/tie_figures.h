// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "src/selfcheck/tally/tally.h"

#include <span>
#include <vector>

namespace fidservo::selfcheck {

/// The fractions of ties that were resolved by the designed experiment and by the best one of the list, out
/// of the ties for which an experiment was designed (src/selfcheck/ties.h).
std::vector<ShareFigure> tie_shares(std::span<const Outcome> outcomes);

}  // namespace fidservo::selfcheck
