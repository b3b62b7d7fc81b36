// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The order of visits: first the recipe's, then once more the sites that were deferred.
#include "src/inspect/measure/results.h"
#include "src/inspect/recipe/recipe.h"

#include <optional>
#include <vector>

namespace fidservo::inspect {

struct NextVisit {
    const Site* site;
    bool again;  ///< the second visit of a site that was deferred
};

/// The next visit, as a function of the visits so far only, so that a resumed run takes the same course.
/// Empty: all done.
std::optional<NextVisit> next_visit(const std::vector<Site>& sites, const std::vector<Visit>& visits);

/// What to do after a failure.
enum class Remedy { retry, defer, skip };

/// @param failures  number of failures at this visit, this one included
Remedy remedy_for(const OnFailure& rule, int failures, bool again);

}  // namespace fidservo::inspect
