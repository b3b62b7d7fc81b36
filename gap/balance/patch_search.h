// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The places on the rail where errors of the encoder show raised friction, if any.
#include "gap/evidence.h"

#include <vector>

namespace fidservo::gap {

/// Friction of F exp(-((y - c) / w)^2 / 2) sgn(v) around a place c on the rail.
struct FrictionPatch {
    double level_V = 0.0, centre_mm = 0.0, width_mm = 0.0;
    double share = 0.0;  ///< of the weighted squares that it takes beside a constant, dry and viscous force
};

/// Least squares of a bell's force over places and widths, beside forces that know no place; windows weighted
/// as in gap/fit/score.h.
/// @param errors  of the encoder are used where they are not NaN
/// @return at most four, none within two widths of a stronger one; strongest first
std::vector<FrictionPatch> strongest_patches(const Evidence& evidence, const Errors& errors);

}  // namespace fidservo::gap
