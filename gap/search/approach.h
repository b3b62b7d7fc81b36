// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// From a distant start to the neighbourhood of an optimum, for fits of many candidates at once.
//
// Far from the optimum, errors up to a level of a floors, a^2 = 1 + the median of S_w, count as noise
// (gap/fit/fit.h), so that all windows draw the fit and not only those with the smallest errors; the level
// falls with the median from one fit to the next.
#include "gap/candidates/candidate.h"
#include "gap/fit/fit.h"
#include "gap/fit/score.h"

#include <span>

namespace fidservo::gap {

/// How far an approach came.
struct Approach {
    Hypothesis settings;
    /// Median mean square, in floors^2, over the windows that tell how far it is to the optimum: those that
    /// are off where the candidates have no effect. Of several signals, that of the one furthest off.
    double median_square;

    /// Whether at least half of these windows are predicted nearly to their floors.
    bool is_near() const { return median_square < near_square; }
    /// The mean square below which a window is near its floor.
    static constexpr double near_square = off_square;
};

/// Fits in several steps, until nothing improves; none from a start that is near. A scale error of the
/// encoder, whose fits end at the nearest count, begins each step with its best value within counts
/// (settings_within_counts()).
/// @param candidates  of the settings, in their order
/// @param predict     errors in the windows that are wanted
/// @param options     of each step, but for its end and its noise
Approach approach(const Evidence& evidence, std::span<const Candidate* const> candidates,
                  const Predict& predict, const Wanted& wanted, Hypothesis start, FitOptions options);

/// The median mean square, in floors^2, of errors over the windows that tell how far it is to the optimum.
double median_square_off(const Evidence& evidence, const Wanted& wanted, const Errors& errors);

}  // namespace fidservo::gap
