// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which effects explain recordings: forward selection with exchange and deletion, judged on windows that were
// not fitted.
#include "gap/candidates/candidate.h"
#include "gap/fit/fit.h"
#include "gap/search/chain.h"

#include <vector>

namespace fidservo::gap {

struct Selection {
    std::vector<Choice> choices;  ///< that first which alone would make the largest gap
    std::vector<CrossFit> steps;  ///< with the first 0, 1, 2 ... of them
    std::vector<Trial> alone;     ///< what was tried first, alone, best first
    /// What was taken in and must not be named, Candidate::is_limit, where it left nothing.
    std::vector<const Candidate*> limits;
    Ended ended = Ended::finished;  ///< or before all was tried that might do better
};

struct SelectionOptions {
    std::size_t most_effects = 4;  ///< that are added one by one
    SearchOptions search;
};

/// All effects of a cross fit, fitted to all windows from what one half gave.
Fit fit_to_all(const Evidence& evidence, const CrossFit& cross);

/// The best that was found when the search ended by itself, or by the evidence's budget.
Selection select(const Evidence& evidence, const std::vector<Candidate>& candidates,
                 const SelectionOptions& options = {});

}  // namespace fidservo::gap
