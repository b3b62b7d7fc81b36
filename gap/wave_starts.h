#pragma once
// From which waves along the rail a fit should begin.
#include "gap/first_sight.h"
#include "gap/period_search.h"

namespace fidservo::gap {

/// What at_first_sight is to other candidates, for one that has a wave: friction holds a weak force and lets
/// go of a strong one, so that errors do not change in proportion to the amplitude. Begins with the waves
/// that the errors show, tries larger ones, and the periods beside those that promise most, in step at the
/// middle of the rail.
std::vector<Promise> waves_at_first_sight(const Predict& predict, std::span<const Window> windows,
                                          const Wanted& counted, const Surroundings& beside,
                                          const Candidate& candidate,
                                          std::span<const PositionPeriod> periods);

}  // namespace fidservo::gap
