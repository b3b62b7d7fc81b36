// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Numerical derivatives of errors with respect to parameters.
#include "gap/candidates/scaled_parameters.h"
#include "gap/fit/fit.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace fidservo::gap {

/// Derivatives of the errors with respect to a hypothesis's parameters, from which a fit nearby can start.
struct KnownSlopes {
    Hypothesis at;
    Errors errors;  ///< under this hypothesis
    /// One for each parameter in order, per scale of the parameter; empty: not known.
    std::vector<Errors> by_parameter;
};

/// The derivative with respect to parameter k, per scale of it, by a one-sided difference. 0 for a parameter
/// on which the errors do not depend locally, and where the plant refuses the neighbouring value.
Errors slope(const Predict& predict, const ScaledParameters& parameters, std::size_t k, const Errors& errors,
             double step_scales = usual_step);

/// The derivatives at the present values of some parameters, updated by Broyden's rank-one formula from those
/// of a hypothesis nearby that has at least the same effects. Empty if they mispredict how the errors have
/// changed from there.
/// @param errors   at the present values
/// @param counted  the windows whose errors count
std::optional<std::vector<Errors>> updated_slopes(const KnownSlopes& nearby,
                                                  const ScaledParameters& parameters, const Errors& errors,
                                                  std::span<const Window> windows,
                                                  std::span<const std::size_t> counted);

}  // namespace fidservo::gap
