// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Periodic forces along the rail: start values from the periods in the readings, and from the balance of a
// carriage's forces.
#include "gap/balance/period_search.h"
#include "gap/candidates/candidate.h"

#include <span>
#include <vector>

namespace fidservo::gap {

/// Converts periods that were found by counts of the nominal resolution to periods on the rail under a
/// hypothesis, which may have another resolution.
std::vector<PositionPeriod> on_the_rail(std::vector<PositionPeriod> periods, const Rig& rig,
                                        const Hypothesis& hypothesis);

/// The candidate's setting for the wave at a period.
plant::EffectSetting wave_at(const Candidate& candidate, const PositionPeriod& period);

/// The best settings of a wave, fitted from the strongest periods, without and with its optional parameters,
/// its harmonic: the balance hardly shows a weak harmonic, although it may decide into which well of the
/// force a carriage goes.
/// @param wanted  windows of the encoder to be used
/// @param base    the known effects
/// @param candidate  a wave; for one that is no force the result is empty
/// @param periods  strongest first
/// @return at most two without and two with the optional parameters, best first
std::vector<plant::EffectSetting> balanced_waves(const Evidence& evidence, const Wanted& wanted,
                                                 const Hypothesis& base, const Candidate& candidate,
                                                 std::span<const PositionPeriod> periods);

}  // namespace fidservo::gap
