// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The correction of a carried carriage state by the counts of the 100 ms after it (carriage_link.h).
#include <span>

namespace fidservo::gap {

/// Corrections of the state at the first count: place in counts, and the velocity as the way
/// tau dv that it leads to, in counts.
struct StartCorrection {
    double place_count = 0.0;
    double coast_count = 0.0;
};

/// The best correction: Newton's method on start_loss() from `done`, where the errors were found.
/// @param error_count  prediction minus count, tick by tick, with `done` applied
/// @param ticks_per_tau  of the velocity's decay
StartCorrection estimate_start(std::span<const double> error_count, const StartCorrection& done,
                               double ticks_per_tau);

/// What remains with `done` applied: half the sum of squares beyond rounding and of the prior, in standard
/// deviations.
double start_loss(std::span<const double> error_count, const StartCorrection& done);

}  // namespace fidservo::gap
