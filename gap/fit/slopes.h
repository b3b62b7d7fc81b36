// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Numerical derivatives of errors with respect to parameters.
#include "gap/candidates/scaled_parameters.h"
#include "gap/fit/fit.h"

namespace fidservo::gap {

/// The derivative with respect to parameter k, per scale of it, by a one-sided difference. 0 for a parameter
/// on which the errors do not depend locally, and where the plant refuses the neighbouring value.
Errors slope(const Predict& predict, const ScaledParameters& parameters, std::size_t k, const Errors& errors,
             double step_scales = usual_step);

}  // namespace fidservo::gap
