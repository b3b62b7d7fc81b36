#pragma once
// Waves of a force along the rail that balance a carriage's forces best.
#include "gap/candidate.h"
#include "gap/period_search.h"

#include <span>
#include <vector>

namespace fidservo::gap {

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
