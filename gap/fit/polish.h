// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Fits without derivatives.
#include "gap/candidates/coupling.h"
#include "gap/fit/fit.h"

namespace fidservo::gap {

/// Minimises the windows' total loss over the parameters of some of the hypothesis's settings, from their
/// present values, by the downhill simplex (Nelder and Mead, The Computer Journal 7, 1965; OpenCV). With
/// stick-slip the loss is discontinuous in the parameters, so that fits by derivatives end in one of many
/// local minima.
/// @param counted  which windows to fit
/// @param places  indices of the settings to fit
/// @return the start where nothing is better; without covariance
Fit polish(const Predict& predict, std::span<const Window> windows, const Wanted& counted,
           const Hypothesis& start, const Places& places);

}  // namespace fidservo::gap
