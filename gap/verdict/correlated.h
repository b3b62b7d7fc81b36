// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Parameters of different effects that recordings determine only together.
#include "gap/fit/fit.h"

#include <string>
#include <vector>

namespace fidservo::gap {

/// A line for each pair of parameters whose estimates are correlated by 0.95 or more in magnitude, strongest
/// first: "coulomb_friction level_V and viscous_friction factor are known only together (correlation -0.98):
/// ...".
std::vector<std::string> correlated_parameters(const Fit& fitted);

}  // namespace fidservo::gap
