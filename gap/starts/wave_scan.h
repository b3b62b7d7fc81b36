// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A weak wave of force along the rail, found by scanning all possible ones.
#include "core/macro_parameters.h"
#include "gap/candidates/candidate.h"
#include "gap/fit/fit.h"

#include <functional>
#include <optional>
#include <span>

namespace fidservo::gap {

/// The wave that predicts some windows best, of all periods up to 25 mm, all phases, and amplitudes that
/// alone would move a carriage at 0.7, 1.5 and 4 mm/s. The balance of forces does not show so weak a wave;
/// only the way that a carriage takes while its command is in the dead zone does. As it may take many ways,
/// no local fit leads there from a wave half a period beside. By successive halving (Jamieson and Talwalkar
/// 2016): all waves on a few windows, the best of them on more.
/// @param predictor  makes the prediction of the flagged windows
/// @param asked      windows to predict; those in which the base is far off tell most
/// @param candidate  an effect with a wave of force
/// @return empty where there is no window to predict
std::optional<plant::EffectSetting> scan_for_wave(const std::function<Predict(Wanted)>& predictor,
                                                  std::span<const Window> windows, const Wanted& asked,
                                                  const Hypothesis& base, const Candidate& candidate,
                                                  const MacroParameters& macro);

}  // namespace fidservo::gap
