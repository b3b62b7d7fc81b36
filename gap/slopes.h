#pragma once
// How errors change with parameters.
#include "gap/fit.h"
#include "gap/scaled_parameters.h"

namespace fidservo::gap {

/// Change of the errors with parameter k, a scale of it: a difference over a step. 0 where the plant refuses
/// the value beside.
Errors slope(const Predict& predict, const ScaledParameters& parameters, std::size_t k, const Errors& errors,
             double step_scales = usual_step);

}  // namespace fidservo::gap
