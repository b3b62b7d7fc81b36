// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Results of a search about each candidate. A result is used again beside another base if the two bases
// differ only in settings on which the candidate's fit does not depend.
#include "gap/starts/first_sight.h"

#include <array>
#include <deque>
#include <optional>
#include <vector>

namespace fidservo::gap {

/// How a close fit of a candidate was sought: not at all, from the end of its first, coarse fit, or, for a
/// wave or a spring, also from many randomly drawn start values.
enum class Sought { nowhere, from_there, among_many };

/// Results about a candidate, beside given values of those settings of the base on which its fit depends.
struct Finding {
    std::array<Hypothesis, 2> beside;  ///< these settings of the base, as fitted on each half
    bool is_looked_at = false;         ///< whether start values were looked for
    bool is_scanned = false;           ///< for a wave: whether all possible waves were scanned
    std::vector<Promise> starts;       ///< best first
    /// The settings that are fitted with the candidate, then the candidate, as fitted on each half; empty
    /// before the fit.
    std::array<Hypothesis, 2> fitted;
    /// The most thorough way in which a close fit was sought so far.
    Sought sought = Sought::nowhere;
};

class SearchMemory {
  public:
    explicit SearchMemory(std::size_t candidates) : findings_(candidates) {}

    /// The finding for a candidate beside these settings; an empty one is added if there is none. Its address
    /// does not change. Not to be called from two threads at once.
    Finding& of(std::size_t candidate, const std::array<Hypothesis, 2>& beside);

  private:
    std::vector<std::deque<Finding>> findings_;
};

}  // namespace fidservo::gap
