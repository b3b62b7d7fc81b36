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

/// Values of the wave or the spring at a place of a hypothesis that predict best among many drawn around the
/// best so far, ever closer: where friction lets a carriage go by jumps, a small force along the rail decides
/// each time whether it goes, and losses have a valley for each way in which it may.
Fit scatter(const Predict& predict, std::span<const Window> windows, const Wanted& counted,
            const Hypothesis& start, std::size_t place);

}  // namespace fidservo::gap
