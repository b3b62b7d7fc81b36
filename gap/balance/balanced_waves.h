// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Waves of a force along the rail: as periods in the readings show them, and as they balance a carriage's
// forces best.
#include "gap/balance/period_search.h"
#include "gap/candidates/candidate.h"

#include <span>
#include <vector>

namespace fidservo::gap {

/// Periods that were found by counts of the nominal length, as a hypothesis has them on the rail, where a
/// count may have another length.
std::vector<PositionPeriod> on_the_rail(std::vector<PositionPeriod> periods, const Rig& rig,
                                        const Hypothesis& hypothesis);

/// The candidate as the wave that a period's errors show.
plant::EffectSetting wave_at(const Candidate& candidate, const PositionPeriod& period);

/// From the strongest periods in all parameters of the wave, without and with those that it may be without,
/// its harmonic: a weak one the balance hardly shows, though it decides which way a carriage goes.
/// @param wanted  windows of the encoder that are looked at
/// @param base    what is known of the rig
/// @param candidate  a wave; one that is no force has none
/// @param periods  strongest first
/// @return at most two of either, best first
std::vector<plant::EffectSetting> balanced_waves(const Evidence& evidence, const Wanted& wanted,
                                                 const Hypothesis& base, const Candidate& candidate,
                                                 std::span<const PositionPeriod> periods);

}  // namespace fidservo::gap
