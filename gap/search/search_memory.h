// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a search has found out about a candidate, so that it need not find it out again beside another base
// that differs only in what the candidate does not meet.
#include "gap/search/first_sight.h"

#include <array>
#include <deque>
#include <optional>
#include <vector>

namespace fidservo::gap {

/// Where something closer was looked for: from where a fit ended, or also of a wave or a spring among many
/// values.
enum class Sought { nowhere, from_there, among_many };

/// Of a candidate beside those settings of a base that it meets.
struct Finding {
    std::array<Hypothesis, 2> beside;  ///< as fitted on each half
    bool is_looked_at = false;         ///< whether starts were looked for
    bool is_scanned = false;           ///< whether they were, of a wave, among all that there may be
    std::vector<Promise> starts;       ///< best first
    std::array<Hypothesis, 2> fitted;  ///< on each half: what is beside, then the candidate; empty before
    Sought sought = Sought::nowhere;   ///< where more was looked for than that, and nothing is left to find
};

class SearchMemory {
  public:
    explicit SearchMemory(std::size_t candidates) : findings_(candidates) {}

    /// Stays where it is. Not to be called from two threads at once.
    Finding& of(std::size_t candidate, const std::array<Hypothesis, 2>& beside);

  private:
    std::vector<std::deque<Finding>> findings_;
};

}  // namespace fidservo::gap
