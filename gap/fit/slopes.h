// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How errors change with parameters.
#include "gap/candidates/scaled_parameters.h"
#include "gap/fit/fit.h"

namespace fidservo::gap {

/// Change of the errors with parameter k, a scale of it: a difference over a step. 0 where the plant refuses
/// the value beside.
Errors slope(const Predict& predict, const ScaledParameters& parameters, std::size_t k, const Errors& errors,
             double step_scales = usual_step);

}  // namespace fidservo::gap
