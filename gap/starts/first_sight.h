// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The promise of a candidate (the loss that it would save, estimated without a fit), and start values of its
// fit.
#include "gap/candidates/candidate.h"
#include "gap/candidates/coupling.h"
#include "gap/candidates/scaled_parameters.h"
#include "gap/fit/fit.h"
#include "gap/numbers.h"
#include "gap/starts/linear_errors.h"

#include <vector>

#include <Eigen/Core>

namespace fidservo::gap {

/// The base to which candidates are tentatively added. Its settings that are coupled with a candidate may be
/// refitted with it.
struct Surroundings {
    Hypothesis base;
    Errors errors;  ///< of the base
    Places places;  ///< indices of the settings that may be refitted
    ScaledParameters parameters;
    LinearErrors linear;  ///< the errors, and their derivatives with respect to these parameters
    /// Errors of the base when these parameters are refitted to first order; empty if there are none.
    Errors moved;
};

/// @param windows  must outlive what is returned
/// @param counted  those of them that `predict` predicts
Surroundings surroundings(const Predict& predict, std::span<const Window> windows, const Wanted& counted,
                          const Hypothesis& base, const Errors& base_errors, const Places& places);

/// A candidate whose sizes are the given shares of those at a point of its grid.
/// @param shape  the point: values of all parameters
plant::EffectSetting sized(const Candidate& candidate, const std::vector<double>& shape,
                           const Eigen::VectorXd& shares);

/// Start values from which a fit is begun.
inline constexpr std::size_t most_starts = beam;

struct Promise {
    Hypothesis start;  ///< the settings that may be refitted, then the candidate
    double gain;       ///< loss that it saves, without a fit, in the counted windows
};

/// The promise of a setting in addition to the base, all of whose settings keep their values.
/// @param base_squares  mean squares of the base's errors (gap/fit/score.h)
Promise promise_of(plant::EffectSetting setting, const Predict& predict, std::span<const Window> windows,
                   const Wanted& counted, const Surroundings& beside, std::span<const double> base_squares);

/// Start values of a candidate's fit, at most four, best first. At each point of its grid the sizes are
/// estimated by weighted linear least squares of the base's errors, together with the base's parameters that
/// may be refitted, since these have adapted to the absence of the candidate. If the linear estimate is bad,
/// as with a base of which only a product of parameters is well determined, the candidate is tried without
/// refitting the base. `gain` is computed from an actual prediction. Empty if refitting the base's parameters
/// saves as much without the candidate.
std::vector<Promise> at_first_sight(const Predict& predict, std::span<const Window> windows,
                                    const Wanted& counted, const Surroundings& beside,
                                    const Candidate& candidate);

}  // namespace fidservo::gap
