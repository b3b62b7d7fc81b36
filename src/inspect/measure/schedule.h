// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which site comes next: the recipe's order first, then, once more, those that were put off.
#include "src/inspect/measure/results.h"
#include "src/inspect/recipe/recipe.h"

#include <optional>
#include <vector>

namespace fidservo::inspect {

struct NextVisit {
    const Site* site;
    bool again;  ///< the second visit of a site that was deferred
};

/// A pure function of the visits so far, so that a resumed run goes the same way. Empty: all done.
std::optional<NextVisit> next_visit(const std::vector<Site>& sites, const std::vector<Visit>& visits);

/// What to do after a failure.
enum class Remedy { retry, defer, skip };

/// @param failures  at this visit so far, this one included
Remedy remedy_for(const OnFailure& rule, int failures, bool again);

}  // namespace fidservo::inspect
