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

/// Half a minute: less than that for the names, of which four fifths are the search's; the rest is for an
/// equation.
inline constexpr TimeLimit half_a_minute{0.8 * 18.0, 18.0, 8.5};

/// Half a minute, and where recordings are longer than ten minutes, 84 s more for each further hour.
TimeLimit time_limit(const std::vector<Recording>& recordings);

}  // namespace fidservo::diagnose
