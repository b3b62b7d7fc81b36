// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Time limits of a diagnosis.
#include "core/recording.h"

#include <vector>

namespace fidservo::diagnose {

struct TimeLimit {
    double search_s;  ///< time until the search must have ended
    double whole_s;   ///< time for everything
    /// Additional time for an equation, where something remains unexplained.
    double equation_s = 0.0;
};

/// Half a minute. The search ends after two thirds of it, and its evaluation takes a second or two; the rest
/// is for an equation.
inline constexpr TimeLimit half_a_minute{19.0, 26.0, 1.5};

/// Half a minute, and where recordings are longer than ten minutes, 84 s more for each further hour.
TimeLimit time_limit(const std::vector<Recording>& recordings);

}  // namespace fidservo::diagnose
