// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// From a distant start to the neighbourhood of an optimum, for fits of many candidates at once.
//
// Far from the optimum, the noise level of the fit (gap/fit/fit.h) is raised to a floors, a^2 = 1 + median of
// S_w, with S_w the mean square error of window w in floors^2. All windows then draw the fit and not only
// those with the smallest errors. The level falls with the median from one fit to the next.
#include "gap/candidates/candidate.h"
#include "gap/fit/fit.h"
#include "gap/fit/score.h"

#include <span>

namespace fidservo::gap {

/// The result of an approach.
struct Approach {
    Hypothesis settings;
    /// How far `settings` are from the optimum: the median of S_w, floors^2, over the windows that are off
    /// their floors if the candidates have no effect. If there are windows of several signals, the largest of
    /// their medians.
    double median_square;

    /// Whether at least half of these windows are predicted nearly to their floors.
    bool is_near() const { return median_square < near_square; }
    /// The mean square below which a window is near its floor.
    static constexpr double near_square = off_square;
};

/// Fits in several steps, until the median of S_w no longer halves, but at most six. A start that is near the
/// optimum is not fitted. The loss as a function of an encoder's scale error has a minimum for each count;
/// each step starts from the best of the values in settings_within_counts().
/// @param candidates  whose settings `start` has, in the same order
/// @param predict     errors in the windows that are wanted
/// @param options  for the fit of each step; number of iterations, tolerance and noise level are overwritten
Approach approach(const Evidence& evidence, std::span<const Candidate* const> candidates,
                  const Predict& predict, const Wanted& wanted, Hypothesis start, FitOptions options);

/// The median of S_w, floors^2, over those wanted windows that the given errors leave off their floors; if
/// there are windows of several signals, the largest of their medians.
double median_square_off(const Evidence& evidence, const Wanted& wanted, const Errors& errors);

}  // namespace fidservo::gap
