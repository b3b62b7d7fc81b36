// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Waves along the rail from which a fit may begin.
#include "gap/balance/period_search.h"
#include "gap/candidates/candidate.h"
#include "gap/starts/first_sight.h"

namespace fidservo::gap {

/// Share of the loss that a wave has to save, since errors show one of many periods by chance.
inline constexpr double worth_of_wave = 0.2;

/// Start values of a candidate that has a wave, in place of at_first_sight: waves with the periods that
/// errors show (gap/balance/period_search.h), sorted by the loss that they promise to save.
/// @param balanced  settings of waves that balance the forces (gap/balance/balanced_waves.h), of this
/// candidate or others
std::vector<Promise> waves_at_first_sight(const Predict& predict, std::span<const Window> windows,
                                          const Wanted& counted, const Surroundings& beside,
                                          const Candidate& candidate, std::span<const PositionPeriod> periods,
                                          std::span<const plant::EffectSetting> balanced);

}  // namespace fidservo::gap
