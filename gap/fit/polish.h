// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Fits where derivatives mislead.
#include "gap/candidates/coupling.h"
#include "gap/fit/fit.h"

namespace fidservo::gap {

/// Lowers the windows' total loss over the parameters of some of the hypothesis's settings from where they
/// are, by a simplex (Nelder and Mead, The Computer Journal 7, 1965; OpenCV). Whether friction holds or lets
/// go depends on a parameter by jumps, so that fits by derivatives end in any of many small valleys.
/// @param counted  which windows to fit
/// @param places  of the settings that move
/// @return the start where nothing is better; no covariance
Fit polish(const Predict& predict, std::span<const Window> windows, const Wanted& counted,
           const Hypothesis& start, const Places& places);

}  // namespace fidservo::gap
