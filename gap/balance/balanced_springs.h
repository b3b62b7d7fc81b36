// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A spring along the rail that balances a carriage's forces best.
#include "gap/balance/force_balance.h"
#include "gap/candidates/candidate.h"

#include <vector>

namespace fidservo::gap {

/// Whether an effect pulls in proportion to a way along the rail.
bool is_spring(const plant::Effect& effect);

/// As it is without the parameters that it may be without, and with one of them: where friction lets a
/// carriage go by jumps, no slope leads from one that does not harden to one that does.
/// @param wanted  windows of the encoder that are looked at
/// @param base    what is known of the rig
/// @param candidate  a spring; what is none has none
std::vector<plant::EffectSetting> balanced_springs(const Evidence& evidence, const Wanted& wanted,
                                                   const Hypothesis& base, const Candidate& candidate);

}  // namespace fidservo::gap
