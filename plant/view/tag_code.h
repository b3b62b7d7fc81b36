// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A fiducial as cells of ink.
#include "core/plate.h"
#include "plant/view/cell_grid.h"

namespace fidservo::plant::view {

/// What is printed of a tag, without the paper around it.
struct PrintedTag {
    CellPattern pattern;
    double side_mm;  ///< side of all that is printed
};

/// An inverted tag is a sheet of ink that extends one cell beyond its border on all sides, with white cells
/// in it. Throws InputError for an id that the family does not have.
PrintedTag printed_tag(const PlateTag& tag);

}  // namespace fidservo::plant::view
