// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The values of a port's variables along recordings, by the readings and the rig file's model.
#include "gap/evidence.h"
#include "plant/formulas/formula_code.h"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace fidservo::gap {

/// The variables of a site at one time, in the order of plant/formulas/port.h.
using SeenVariables = std::array<double, plant::most_variables>;

/// The variables in each row of a recording, or for the camera at each detection. Variables that the rig does
/// not have are NaN.
std::vector<SeenVariables> variables_along(const Evidence& evidence, plant::Site site, std::size_t run);

/// The values of a formula along a recording, memories included (plant/formulas/formulas.h).
/// @param parameters  in the effect's order
std::vector<double> values_along(const Evidence& evidence, const plant::FormulaCode& code,
                                 std::span<const double> parameters, std::size_t run);

}  // namespace fidservo::gap
