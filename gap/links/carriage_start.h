// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The correction of a simulated carriage's state by the counts of the following 100 ms
// (gap/links/carriage_link.h).
#include <span>

namespace fidservo::gap {

/// Corrections of the state at the first count, in counts: `place_count` of the position, and `coast_count` =
/// tau dv for a correction dv of the velocity, the distance that the carriage covers while dv decays.
struct StartCorrection {
    double place_count = 0.0;
    double coast_count = 0.0;
};

/// The best correction, by Newton's method on start_loss(). The loss is convex, but only piecewise quadratic,
/// since errors count only beyond half a count; a Newton step is halved until it lowers the loss.
/// @param error_count  prediction minus count, tick by tick, with the correction `done` applied
/// @param ticks_per_tau  time constant of the velocity's decay, in ticks
StartCorrection estimate_start(std::span<const double> error_count, const StartCorrection& done,
                               double ticks_per_tau);

/// How the error of a tick changes with a correction, per count.
struct StartSlope {
    double per_place, per_coast;
};

/// The same for a velocity whose errors do not just decay, but as the given slopes say, one a tick.
StartCorrection estimate_start(std::span<const double> error_count, const StartCorrection& done,
                               std::span<const StartSlope> slopes);

/// The loss of a correction: half the sum of the squares of the errors beyond rounding and of the correction
/// itself (the prior), each in standard deviations.
double start_loss(std::span<const double> error_count, const StartCorrection& done);

}  // namespace fidservo::gap
