// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The picture of a fiducial as cells of ink.
#include "core/plate.h"
#include "plant/view/cell_grid.h"

namespace fidservo::plant::view {

/// What is printed of a tag, without the paper around it.
struct PrintedTag {
    CellPattern pattern;
    double side_mm;  ///< of all that is printed
};

/// An inverted tag is a sheet of ink, one cell wider all around than its border, with paper showing through.
/// Throws InputError for an id that the family does not have.
PrintedTag printed_tag(const PlateTag& tag);

}  // namespace fidservo::plant::view
