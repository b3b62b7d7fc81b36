// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The periods in position that errors of the encoder show, if any.
#include "gap/evidence.h"

#include <cstddef>
#include <vector>

namespace fidservo::gap {

/// Of waves that are looked for along the rail.
inline constexpr double longest_period_mm = 50.0;

/// A sin(2 pi y / p + phase) of the place y on the rail.
struct Wave {
    double amplitude = 0.0, phase_rad = 0.0;
};

/// A period, and the waves of it that take most of what is lacking: of a force along the rail, and of the
/// reading itself. What is found has the opposite sign of what is lacking.
struct PositionPeriod {
    double period_mm = 0.0;
    double share = 0.0;            ///< of the weighted squares, 0 .. 1
    std::size_t half_support = 0;  ///< over which it shows, rows (gap/balance/carriage_forces.h)
    Wave force_V{}, reading_mm{};
};

/// Linear periodogram over 0.8 mm to 50 mm (Lomb, Scargle: least squares of sine and cosine), windows
/// weighted as in gap/fit/score.h; once by forces over 25 rows, in which a carriage at 100 mm/s covers half a
/// wave of 5 mm, and once over 51, which show weaker forces.
/// @param errors  of the encoder are used where they are not NaN
/// @return the strongest four of either, none within two steps of the search from a stronger one; strongest
/// first
std::vector<PositionPeriod> strongest_periods(const Evidence& evidence, const Errors& errors);

}  // namespace fidservo::gap
