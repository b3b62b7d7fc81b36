// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a search has found out about a candidate. It is used again beside another base if that differs only in
// settings on which the candidate's fit does not depend.
#include "gap/starts/first_sight.h"

#include <array>
#include <deque>
#include <optional>
#include <vector>

namespace fidservo::gap {

/// How a closer fit of a candidate was sought: not at all, from where the first fit ended, or, for a wave or
/// a spring, also from many drawn values.
enum class Sought { nowhere, from_there, among_many };

/// About a candidate beside those settings of a base on which its fit depends.
struct Finding {
    std::array<Hypothesis, 2> beside;  ///< these settings, as fitted on each half
    bool is_looked_at = false;         ///< whether start values were looked for
    bool is_scanned = false;           ///< for a wave: whether all possible waves were scanned
    std::vector<Promise> starts;       ///< best first
    /// The settings that are fitted with the candidate, then the candidate, as fitted on each half; empty
    /// before the fit.
    std::array<Hypothesis, 2> fitted;
    /// The most thorough way in which a closer fit was sought; none is left to be found in this way.
    Sought sought = Sought::nowhere;
};

class SearchMemory {
  public:
    explicit SearchMemory(std::size_t candidates) : findings_(candidates) {}

    /// The finding beside these settings, a new one if there is none. Its address does not change. Not to be
    /// called from two threads at once.
    Finding& of(std::size_t candidate, const std::array<Hypothesis, 2>& beside);

  private:
    std::vector<std::deque<Finding>> findings_;
};

}  // namespace fidservo::gap
