// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Fits of forces on a carriage whose loss has many local minima.
#include "gap/candidates/candidate.h"
#include "gap/candidates/coupling.h"
#include "gap/fit/fit.h"

#include <cstddef>
#include <span>

namespace fidservo::gap {

/// Whether the loss of a candidate has many local minima: true for a wave and for a spring.
bool has_valleys(const Candidate& candidate);

/// Values of the settings at some places of a hypothesis that predict best among many drawn at random. Where
/// friction releases a carriage in jumps, a small force along the rail decides each time whether it moves,
/// and the loss has a local minimum for every possible course of the motion; the nearer the values are to the
/// right ones, the more of the course is right. Each generation is therefore drawn around the mean of the
/// best values so far, as widely as these scatter: the cross-entropy method (Rubinstein, Methodology and
/// Computing in Applied Probability 1, 1999) with the weights of Hansen and Ostermeier, Evolutionary
/// Computation 9, 2001. Of effects other than waves and springs only the sizes are drawn.
/// @param spread  factor of the first generation's standard deviations: 1 around a guess, less around a
/// better start
Fit scatter(const Predict& predict, std::span<const Window> windows, const Wanted& counted,
            const Hypothesis& start, const Places& places, double spread = 1.0);

}  // namespace fidservo::gap
