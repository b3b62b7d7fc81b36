// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which effects explain recordings: stepwise selection by addition, exchange and deletion of effects, judged
// on windows that were not fitted.
#include "gap/candidates/candidate.h"
#include "gap/fit/fit.h"
#include "gap/search/chain.h"

#include <vector>

namespace fidservo::gap {

struct Selection {
    std::vector<Choice> choices;  ///< sorted by the gap that each alone would make, largest first
    std::vector<CrossFit> steps;  ///< cross fits with only the first 0, 1, 2 ... of `choices`
    std::vector<Trial> alone;     ///< trials of single effects, best first
    /// Effects that were tried only as simpler forms of others (Candidate::is_limit) and accepted into an
    /// explanation that leaves no gap. They are not named and not in `choices`.
    std::vector<const Candidate*> limits;
    /// If not finished, the search ended before everything promising was tried.
    Ended ended = Ended::finished;
};

struct SelectionOptions {
    std::size_t most_effects = 4;  ///< the largest number of effects that are added one by one
    SearchOptions search;
};

/// All effects of a cross fit, fitted to all windows, starting from the values of the first half.
Fit fit_to_all(const Evidence& evidence, const CrossFit& cross);

/// The best explanation found until the search ended by itself, or by the evidence's budget.
Selection select(const Evidence& evidence, const std::vector<Candidate>& candidates,
                 const SelectionOptions& options = {});

}  // namespace fidservo::gap
