// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// An effect's parameter values as a diagnosis states them.
#include "gap/diagnosis.h"

#include <array>
#include <vector>

#include <Eigen/Core>

namespace fidservo::gap {

/// The parameters of a setting with their standard deviations; negligible optional parameters and default
/// choices are left out.
/// @param halves      fits to each half of the windows: where the loss has many small local minima, their
/// difference measures the uncertainty better than the curvature at one of them
/// @param covariance  of all parameters of a hypothesis; the setting's begin at `first`
std::vector<FittedParameter> parameters_of(const plant::EffectSetting& setting,
                                           const std::array<plant::EffectSetting, 2>& halves,
                                           const Eigen::MatrixXd& covariance, Eigen::Index first);

}  // namespace fidservo::gap
