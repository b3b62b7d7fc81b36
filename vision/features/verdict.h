// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// From a measured value to a decision, with guard bands for the measurement's uncertainty.
#include "vision/features/rest_image.h"

#include <string_view>

namespace fidservo::vision {

enum class Verdict {
    pass,
    fail,
    not_decidable,  ///< the uncertainty is too large for a decision at this tolerance
};

/// The word that stands for a verdict in result files, e.g. "not_decidable".
std::string_view name_of(Verdict verdict);

/// Guarded acceptance and guarded rejection (JCGM 106:2012, 8.3.2 and 8.3.3), guard band k u on either side:
///     pass            |value - nominal| + k u <= tolerance
///     fail            |value - nominal| - k u >  tolerance
///     not decidable   otherwise
/// With k = 2 the probability of a wrong pass or a wrong fail is at most 2.3 %, whatever the true value. All
/// in one unit; u >= 0, tolerance >= 0. A value that is not finite is not decidable.
Verdict decide(const Measured& measured, double nominal, double tolerance, double coverage_factor = 2.0);

/// The one-sided form, for value >= least (a line's narrowest place, a gap).
Verdict decide_at_least(const Measured& measured, double least, double coverage_factor = 2.0);

}  // namespace fidservo::vision
