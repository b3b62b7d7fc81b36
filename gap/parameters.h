// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The values of an effect as a diagnosis states them.
#include "gap/diagnosis.h"

#include <array>
#include <vector>

#include <Eigen/Core>

namespace fidservo::gap {

/// With their standard deviations; without what is negligible, and choices that are as usual.
/// @param halves      as fitted on each half: where fits end in any of many small valleys, what they are
/// apart by
///                    tells more of how sure a value is than the slopes at one of them
/// @param covariance  of all parameters of a hypothesis; the setting's begin at `first`
std::vector<FittedParameter> parameters_of(const plant::EffectSetting& setting,
                                           const std::array<plant::EffectSetting, 2>& halves,
                                           const Eigen::MatrixXd& covariance, Eigen::Index first);

}  // namespace fidservo::gap
