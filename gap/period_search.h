#pragma once
// The periods in position that errors of the encoder show, if any.
#include "gap/evidence.h"

#include <vector>

namespace fidservo::gap {

/// Slower than this the carriage may be held, and no force shows.
inline constexpr double moving_mm_per_s = 1.0;

/// A sin(2 pi y / p + phase) of the place y on the rail.
struct Wave {
    double amplitude = 0.0, phase_rad = 0.0;
};

/// A period, and the waves of it that take most of the errors together: of a force along the rail, passed
/// through the nominal carriage, and of the reading itself. What is found has the opposite sign of the
/// errors.
struct PositionPeriod {
    double period_mm = 0.0;
    double share = 0.0;  ///< of the weighted squares, 0 .. 1
    Wave force_V{}, reading_mm{};
    double step_per_mm = 0.0;  ///< of the search, in 1 / period
    double middle_mm = 0.0;    ///< of the places that were met
};

/// Linear periodogram over 0.8 mm to 50 mm (Lomb, Scargle: least squares of sine and cosine), with the state
/// at each window's start as nuisance, windows weighted as in gap/score.h.
/// @param wanted  windows looked at
/// @return the strongest first, at most six, none within two steps of the search from a stronger one
std::vector<PositionPeriod> strongest_periods(const Evidence& evidence, const Errors& errors,
                                              const Wanted& wanted);

}  // namespace fidservo::gap
