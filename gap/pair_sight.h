#pragma once
// Which two candidates together promise most, where each hides the other.
#include "gap/candidate.h"
#include "gap/fit.h"

#include <span>
#include <vector>

namespace fidservo::gap {

/// Two candidates beside a base.
struct PairSight {
    const Candidate *first, *second;
    Hypothesis settings;  ///< of the two
    double gain;          ///< loss that they save, in the windows counted
};

/// Of all pairs of two classes, along their shapes, those that save most at the sizes that fit best if errors
/// changed in proportion to both; best first, none of the same two candidates as another.
/// @param counted  windows that `predict` predicts
std::vector<PairSight> pairs_at_first_sight(const Predict& predict, std::span<const Window> windows,
                                            const Wanted& counted, const Hypothesis& base,
                                            std::span<const Candidate* const> candidates);

}  // namespace fidservo::gap
