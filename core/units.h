// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Stage positions are mm inside files and code, um where people read errors. Names carry the unit.

namespace fidservo {

/// Micrometres in a millimetre.
inline constexpr double um_per_mm = 1000.0;

/// A length in um.
constexpr double um_from_mm(double x_mm) {
    return x_mm * um_per_mm;
}
/// A length in mm.
constexpr double mm_from_um(double x_um) {
    return x_um / um_per_mm;
}

}  // namespace fidservo
