// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The spring force along the rail that balances a carriage's forces best.
#include "gap/balance/force_balance.h"
#include "gap/candidates/candidate.h"

#include <vector>

namespace fidservo::gap {

/// Whether an effect is a spring: a force in proportion to the position on the rail.
bool is_spring(const plant::Effect& effect);

/// The settings of a spring that balance the forces best: without its optional parameters, and with one of
/// them. Both are needed as start values of simulations: with stick-slip, a gradient-based fit does not get
/// from a linear spring to a hardening one.
/// @param wanted  windows of the encoder to be used
/// @param base    the known effects
/// @param candidate  a spring; for other effects the result is empty
std::vector<plant::EffectSetting> balanced_springs(const Evidence& evidence, const Wanted& wanted,
                                                   const Hypothesis& base, const Candidate& candidate);

}  // namespace fidservo::gap
