// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A weak wave of force along the rail, looked for among all that there may be.
#include "core/macro_parameters.h"
#include "gap/candidates/candidate.h"
#include "gap/fit/fit.h"

#include <functional>
#include <optional>
#include <span>

namespace fidservo::gap {

/// The wave that predicts windows best, of all periods up to 25 mm, all phases, and amplitudes that move a
/// carriage left alone at 0.7, 1.5 and 4 mm/s. No balance of forces shows so weak a wave, only which way a
/// carriage goes that the dead zone leaves alone; and as it may go many ways, nothing leads there from a wave
/// half a turn beside. By successive halving (Jamieson and Talwalkar 2016): all by a few windows, the best of
/// them by more.
/// @param predictor  of the windows flagged
/// @param asked      windows to predict; those in which the base is far off say most
/// @param candidate  with a wave of force
/// @return none where there is nothing to predict
std::optional<plant::EffectSetting> scan_for_wave(const std::function<Predict(Wanted)>& predictor,
                                                  std::span<const Window> windows, const Wanted& asked,
                                                  const Hypothesis& base, const Candidate& candidate,
                                                  const MacroParameters& macro);

}  // namespace fidservo::gap
