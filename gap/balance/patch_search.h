// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Places on the rail where the encoder's errors show raised friction.
#include "gap/evidence.h"

#include <vector>

namespace fidservo::gap {

/// Friction of F exp(-((y - c) / w)^2 / 2) sgn(v) around a place c on the rail.
struct FrictionPatch {
    double level_V = 0.0, centre_mm = 0.0, width_mm = 0.0;
    /// Fraction of the weighted sum of squares of the lacking forces that it explains in addition to a
    /// constant force, dry and viscous friction.
    double share = 0.0;
};

/// Least-squares search for a FrictionPatch over places and widths, fitted together with forces that do not
/// depend on the place; windows are weighted as in gap/fit/score.h.
/// @param errors  of the encoder are used where they are not NaN
/// @return at most four, strongest first, none within two widths of a stronger one
std::vector<FrictionPatch> strongest_patches(const Evidence& evidence, const Errors& errors);

}  // namespace fidservo::gap
