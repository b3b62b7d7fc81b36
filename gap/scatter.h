#pragma once
// A force along the rail among many small valleys.
#include "gap/candidate.h"
#include "gap/coupling.h"
#include "gap/fit.h"

#include <cstddef>
#include <span>

namespace fidservo::gap {

/// Whether an effect is such a force: a wave or a spring.
bool has_valleys(const Candidate& candidate);

/// Values of the wave or the spring at a place of a hypothesis that predict best among many drawn: where
/// friction lets a carriage go by jumps, a small force along the rail decides each time whether it goes, and
/// losses have a valley for each way in which it may. The nearer values are to the right ones, the more ways
/// are right. So each generation is drawn around the mean of the best so far, as widely as these scatter: the
/// cross-entropy method (Rubinstein, Methodology and Computing in Applied Probability 1, 1999) with the
/// weights of Hansen and Ostermeier, Evolutionary Computation 9, 2001.
Fit scatter(const Predict& predict, std::span<const Window> windows, const Wanted& counted,
            const Hypothesis& start, std::size_t place);

}  // namespace fidservo::gap
