// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Periods along the rail in the encoder's errors.
#include "gap/evidence.h"
#include "gap/numbers.h"

#include <cstddef>
#include <vector>

namespace fidservo::gap {

/// The longest period of the waves that are looked for along the rail.
inline constexpr double longest_period_mm = 50.0;

/// The largest number of peaks of a search along the rail that are worth a look.
inline constexpr std::size_t most_peaks = beam;

/// A sin(2 pi y / p + phase) as a function of the position y on the rail.
struct Wave {
    double amplitude = 0.0, phase_rad = 0.0;
};

/// A period, and the two waves of this period that explain most of the errors: a force along the rail, and an
/// error of the reading. They are what the prediction lacks: their sign is that of recording minus
/// prediction.
struct PositionPeriod {
    double period_mm = 0.0;
    double share = 0.0;  ///< fraction of the weighted squares that they explain, 0 .. 1
    /// The half support, in rows, with which the period is strongest (gap/balance/carriage_forces.h).
    std::size_t half_support = 0;
    Wave force_V{}, reading_mm{};
};

/// Linear periodogram over 0.8 mm to 50 mm (Lomb, Scargle: least squares of sine and cosine), windows
/// weighted as in gap/fit/score.h; once from forces over 25 rows, in which a carriage at 100 mm/s covers half
/// a wave of 5 mm, and once over 51 rows, which detect weaker forces.
/// @param errors  of the encoder are used where they are not NaN
/// @return the four strongest periods of each search, strongest first, without those within two grid steps of
/// a stronger one
std::vector<PositionPeriod> strongest_periods(const Evidence& evidence, const Errors& errors);

}  // namespace fidservo::gap
