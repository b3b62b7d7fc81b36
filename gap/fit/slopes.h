// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Numerical derivatives of errors with respect to parameters.
#include "gap/candidates/scaled_parameters.h"
#include "gap/fit/fit.h"

#include <cstddef>
#include <span>
#include <vector>

namespace fidservo::gap {

/// Derivatives of the errors at some values of the parameters.
struct KnownSlopes {
    std::vector<double> values;        ///< of the parameters in order, in their scales
    Errors errors;                     ///< at these values
    std::vector<Errors> by_parameter;  ///< one for each parameter, per scale of it; empty: not known
};

/// The derivative with respect to parameter k, per scale of it, by a one-sided difference. 0 for a parameter
/// on which the errors do not depend locally, and where the plant refuses the neighbouring value.
/// @param step_scales  of effects that move the carriage; of others smooth_step, if that is less
Errors slope(const Predict& predict, const ScaledParameters& parameters, std::size_t k, const Errors& errors,
             double step_scales = usual_step);

/// Updates known derivatives for other values of the same parameters, by Broyden's rank-one formula. Leaves
/// them unchanged if they predict the change of the errors badly.
/// @param errors  at the other values
/// @return whether they were updated
bool move_slopes(KnownSlopes& known, std::span<const double> values, const Errors& errors);

}  // namespace fidservo::gap
