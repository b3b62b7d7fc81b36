// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A weak periodic force along the rail (a wave), found by a scan of all periods and phases.
#include "core/macro_parameters.h"
#include "gap/candidates/candidate.h"
#include "gap/fit/fit.h"

#include <functional>
#include <optional>
#include <span>

namespace fidservo::gap {

/// The wave that predicts some windows best, of all periods up to 25 mm, all phases, and amplitudes that
/// alone would move a carriage at 0.7, 1.5 and 4 mm/s. So weak a wave does not show in the balance of forces,
/// but only in the path that the carriage takes while its command is in the dead zone. There are many
/// possible paths, so that the loss has many local minima and no local fit finds the wave from a phase half a
/// period off. The scan is by successive halving (Jamieson and Talwalkar 2016): all waves on a few windows,
/// the best of them on more.
/// @param predictor  makes the prediction of the flagged windows
/// @param asked  windows to predict; those in which the base is far off are most informative
/// @param candidate  an effect with a wave of force
/// @return empty where there is no window to predict
std::optional<plant::EffectSetting> scan_for_wave(const std::function<Predict(Wanted)>& predictor,
                                                  std::span<const Window> windows, const Wanted& asked,
                                                  const Hypothesis& base, const Candidate& candidate,
                                                  const MacroParameters& macro);

}  // namespace fidservo::gap
