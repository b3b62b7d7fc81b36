#pragma once
// From which waves along the rail a fit should begin.
#include "gap/candidate.h"
#include "gap/first_sight.h"
#include "gap/period_search.h"

namespace fidservo::gap {

/// Periods that were found by counts of the nominal length, as a hypothesis has them on the rail, where a
/// count may have another length.
std::vector<PositionPeriod> on_the_rail(std::vector<PositionPeriod> periods, const Rig& rig,
                                        const Hypothesis& hypothesis);

/// The candidate as the wave that a period's errors show.
plant::EffectSetting wave_at(const Candidate& candidate, const PositionPeriod& period);

/// What at_first_sight is to other candidates, for one that has a wave: the waves that the forces lacking
/// show (gap/period_search.h), those that promise most first.
/// @param balanced  waves that balance forces (gap/balanced_waves.h), of this candidate or another
std::vector<Promise> waves_at_first_sight(const Predict& predict, std::span<const Window> windows,
                                          const Wanted& counted, const Surroundings& beside,
                                          const Candidate& candidate, std::span<const PositionPeriod> periods,
                                          std::span<const plant::EffectSetting> balanced);

}  // namespace fidservo::gap
