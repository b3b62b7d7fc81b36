// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the formulas of a port saw along recordings, by the readings and the rig file's model.
#include "gap/evidence.h"
#include "plant/formulas/formula_code.h"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace fidservo::gap {

/// A site's variables at one moment, in the order of plant/formulas/port.h.
using SeenVariables = std::array<double, plant::most_variables>;

/// Row by row of a recording; of the camera, detection by detection. Variables that the rig has not are NaN.
std::vector<SeenVariables> variables_along(const Evidence& evidence, plant::Site site, std::size_t run);

/// A formula's values there, with what it remembers (plant/formulas/formulas.h).
/// @param parameters  in the effect's order
std::vector<double> values_along(const Evidence& evidence, const plant::FormulaCode& code,
                                 std::span<const double> parameters, std::size_t run);

}  // namespace fidservo::gap
