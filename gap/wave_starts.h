#pragma once
// From which waves along the rail a fit should begin.
#include "gap/first_sight.h"
#include "gap/period_search.h"

namespace fidservo::gap {

/// What at_first_sight is to other candidates, for one that has a wave: the waves that the forces lacking
/// show (gap/period_search.h), those that promise most first.
std::vector<Promise> waves_at_first_sight(const Predict& predict, std::span<const Window> windows,
                                          const Wanted& counted, const Surroundings& beside,
                                          const Candidate& candidate,
                                          std::span<const PositionPeriod> periods);

}  // namespace fidservo::gap
