// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Periodic forces along the rail (waves): start values from the periods in the readings and from the balance
// of the carriage's forces.
#include "gap/balance/period_search.h"
#include "gap/candidates/candidate.h"

#include <span>
#include <vector>

namespace fidservo::gap {

/// Converts periods, mm, that were found with the rig file's encoder resolution to those on the rail under a
/// hypothesis, which may have another resolution.
std::vector<PositionPeriod> on_the_rail(std::vector<PositionPeriod> periods, const Rig& rig,
                                        const Hypothesis& hypothesis);

/// The candidate's setting for the wave at a period.
plant::EffectSetting wave_at(const Candidate& candidate, const PositionPeriod& period);

/// The settings of a wave that balance the forces best, fitted from the strongest periods, without and with
/// its optional parameters (the second harmonic). Both are returned, since a weak harmonic hardly changes the
/// balance but may decide in which well of the force a carriage comes to rest.
/// @param wanted  windows of the encoder to be used
/// @param base    the known effects
/// @param candidate  a wave; for one that is no force the result is empty
/// @param periods  strongest first
/// @return at most two without and two with the optional parameters, best first
std::vector<plant::EffectSetting> balanced_waves(const Evidence& evidence, const Wanted& wanted,
                                                 const Hypothesis& base, const Candidate& candidate,
                                                 std::span<const PositionPeriod> periods);

}  // namespace fidservo::gap
