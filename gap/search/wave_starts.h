// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// From which waves along the rail a fit should begin.
#include "gap/balance/period_search.h"
#include "gap/candidates/candidate.h"
#include "gap/search/first_sight.h"

namespace fidservo::gap {

/// What at_first_sight is to other candidates, for one that has a wave: the waves that the forces lacking
/// show (gap/balance/period_search.h), those that promise most first.
/// @param balanced  waves that balance forces (gap/balance/balanced_waves.h), of this candidate or another
std::vector<Promise> waves_at_first_sight(const Predict& predict, std::span<const Window> windows,
                                          const Wanted& counted, const Surroundings& beside,
                                          const Candidate& candidate, std::span<const PositionPeriod> periods,
                                          std::span<const plant::EffectSetting> balanced);

}  // namespace fidservo::gap
