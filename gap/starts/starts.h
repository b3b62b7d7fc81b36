// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Start values of a candidate's fit: from its grid, and from periods and places on the rail that errors show.
#include "gap/balance/patch_search.h"
#include "gap/balance/period_search.h"
#include "gap/candidates/candidate.h"
#include "gap/starts/first_sight.h"

#include <span>
#include <vector>

namespace fidservo::gap {

/// Periodic forces, springs and patches of friction along the rail that the encoder's errors show.
struct AlongRail {
    std::vector<PositionPeriod> periods;  ///< strongest first
    /// Settings of waves of a force (gap/balance/balanced_waves.h) and of springs
    /// (gap/balance/balanced_springs.h) that balance the carriage's forces.
    std::vector<plant::EffectSetting> balanced;
    std::vector<FrictionPatch> patches;  ///< strongest first
};

/// Periods along the rail that the encoder's errors show, strongest first.
/// @param known  the hypothesis to which the errors belong
std::vector<PositionPeriod> periods_along_rail(const Evidence& evidence, const Hypothesis& known,
                                               const Errors& errors);

/// Analyses the encoder's errors along the rail, as far as any of the candidates needs the result.
/// @param known  the hypothesis to which the errors belong
/// @param wanted  windows that are evaluated
AlongRail seen_along_rail(const Evidence& evidence, const Hypothesis& known, const Wanted& wanted,
                          std::span<const Candidate* const> candidates);

/// Start values of a candidate's fit, best first (gap/starts/first_sight.h).
std::vector<Promise> starts_of(const Candidate& candidate, const AlongRail& along, const Predict& predict,
                               std::span<const Window> windows, const Wanted& counted,
                               const Surroundings& beside);

}  // namespace fidservo::gap
