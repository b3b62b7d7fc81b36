// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Forces of a carriage among many small valleys.
#include "gap/candidates/candidate.h"
#include "gap/candidates/coupling.h"
#include "gap/fit/fit.h"

#include <cstddef>
#include <span>

namespace fidservo::gap {

/// Whether an effect is such a force: a wave or a spring.
bool has_valleys(const Candidate& candidate);

/// Values of the settings at some places of a hypothesis that predict best among many drawn: where friction
/// lets a carriage go by jumps, a small force along the rail decides each time whether it goes, and losses
/// have a valley for each way in which it may. The nearer values are to the right ones, the more ways are
/// right. So each generation is drawn around the mean of the best so far, as widely as these scatter: the
/// cross-entropy method (Rubinstein, Methodology and Computing in Applied Probability 1, 1999) with the
/// weights of Hansen and Ostermeier, Evolutionary Computation 9, 2001. Of other effects than a wave or a
/// spring their sizes are drawn.
/// @param spread  of the first generation: 1 around a guess, less where the start is known better
Fit scatter(const Predict& predict, std::span<const Window> windows, const Wanted& counted,
            const Hypothesis& start, const Places& places, double spread = 1.0);

}  // namespace fidservo::gap
