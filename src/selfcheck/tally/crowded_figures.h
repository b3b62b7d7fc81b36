// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Statistics of cases with many causes at once.
#include "src/selfcheck/tally/tally.h"

#include <span>
#include <vector>

namespace fidservo::selfcheck {

/// Cases with three effects count only if each effect's size is at least judged_floors.
std::vector<ShareFigure> crowded_shares(std::span<const Outcome> outcomes);

std::vector<LimitFigure> crowded_limits(std::span<const Outcome> outcomes);

}  // namespace fidservo::selfcheck
