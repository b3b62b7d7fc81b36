// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How much a candidate promises, and from which values its fit should begin.
#include "gap/candidates/candidate.h"
#include "gap/candidates/coupling.h"
#include "gap/candidates/scaled_parameters.h"
#include "gap/fit/fit.h"

#include <vector>

#include <Eigen/Core>

namespace fidservo::gap {

/// What candidates are looked at beside: a base, of which those settings may move that they are coupled with.
struct Surroundings {
    Hypothesis base;
    Errors errors;  ///< of the base
    Places places;  ///< of the settings that may move
    ScaledParameters parameters;
    std::vector<Errors> slopes;  ///< of these parameters
    Errors moved;                ///< of the base where these parameters alone fit best; empty: none moves
};

/// @param counted  windows that `predict` predicts
Surroundings surroundings(const Predict& predict, std::span<const Window> windows, const Wanted& counted,
                          const Hypothesis& base, const Errors& base_errors, const Places& places);

/// A candidate at sizes that are shares of a shape's.
plant::EffectSetting sized(const Candidate& candidate, const std::vector<double>& shape,
                           const Eigen::VectorXd& shares);

struct Promise {
    Hypothesis start;  ///< the settings that may move, then the candidate
    double gain;       ///< loss that it saves over the base, in the windows counted and predicted
};

/// Of a setting beside the base as it is.
/// @param base_squares  mean squares of the base's errors (gap/fit/score.h)
Promise promise_of(plant::EffectSetting setting, const Predict& predict, std::span<const Window> windows,
                   const Wanted& counted, const Surroundings& beside, std::span<const double> base_squares);

/// Along each shape of the grid the sizes that fit best, together with what moves, if errors changed in
/// proportion to both: weighted least squares of the base's errors. (A base that was fitted without the
/// candidate has taken over what it can of it. Where that misleads, as with a base of which only a product is
/// well known, the candidate alone is tried.) Of the shapes that promise most by that at most four, best
/// first; `gain` is what it really saves. None where the settings that may move save as much without the
/// candidate.
std::vector<Promise> at_first_sight(const Predict& predict, std::span<const Window> windows,
                                    const Wanted& counted, const Surroundings& beside,
                                    const Candidate& candidate);

}  // namespace fidservo::gap
