// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What an answer may take.
#include "core/recording.h"

#include <vector>

namespace fidservo::diagnose {

struct TimeLimit {
    double search_s;  ///< until what is tried must have ended
    double whole_s;   ///< all together
    /// Beyond it, where something is left for which an equation is looked for.
    double equation_s = 0.0;
};

/// Half a minute. What is found in two thirds of it is worked out in a second or two; an equation has what is
/// then left.
inline constexpr TimeLimit half_a_minute{19.0, 26.0, 1.5};

/// Half a minute, and where recordings are longer than ten minutes, 84 s more for each further hour.
TimeLimit time_limit(const std::vector<Recording>& recordings);

}  // namespace fidservo::diagnose
