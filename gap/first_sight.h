#pragma once
// How much a candidate promises, and from which values its fit should begin.
#include "gap/candidate.h"
#include "gap/fit.h"

namespace fidservo::gap {

struct Promise {
    Hypothesis start;  ///< the base with the candidate
    double gain;       ///< loss that it saves over the base, in the windows counted and predicted
};

/// Along each shape of the grid the sizes that fit best if errors changed in proportion to them: weighted
/// least squares of the base's errors against what each size changes. Of the shapes that promise most by
/// that at most four, best first; `gain` is what it really saves.
std::vector<Promise> at_first_sight(const Predict& predict, std::span<const Window> windows,
                                    const Wanted& counted, const Hypothesis& base, const Errors& base_errors,
                                    const Candidate& candidate);

}  // namespace fidservo::gap
