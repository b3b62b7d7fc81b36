// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Where fits of a candidate begin: at what its own grid promises, and at what errors show along the rail.
#include "gap/balance/patch_search.h"
#include "gap/balance/period_search.h"
#include "gap/candidates/candidate.h"
#include "gap/search/first_sight.h"

#include <span>
#include <vector>

namespace fidservo::gap {

/// What errors of the encoder show along the rail.
struct AlongRail {
    std::vector<PositionPeriod> periods;  ///< strongest first
    /// Waves of a force (gap/balance/balanced_waves.h), and springs (gap/balance/balanced_springs.h).
    std::vector<plant::EffectSetting> balanced;
    std::vector<FrictionPatch> patches;  ///< strongest first
};

/// Periods on the rail, strongest first.
/// @param known  of which the errors are
/// @param errors  of the encoder
std::vector<PositionPeriod> periods_along_rail(const Evidence& evidence, const Hypothesis& known,
                                               const Errors& errors);

/// As far as some candidate asks for it.
/// @param known  of which the errors are
/// @param wanted  windows that are looked at
AlongRail seen_along_rail(const Evidence& evidence, const Hypothesis& known, const Wanted& wanted,
                          std::span<const Candidate* const> candidates);

/// Best first (gap/search/first_sight.h).
std::vector<Promise> starts_of(const Candidate& candidate, const AlongRail& along, const Predict& predict,
                               std::span<const Window> windows, const Wanted& counted,
                               const Surroundings& beside);

}  // namespace fidservo::gap
