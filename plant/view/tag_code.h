#pragma once
// The code book of the fiducials.
#include "plant/view/cell_grid.h"

#include <string_view>

namespace fidservo::plant::view {

/// The black cells of a tag as printed upright: black border and code, without the white quiet zone.
/// Throws InputError for a family other than tag36h11 and for an id that the family does not have.
CellPattern tag_pattern(std::string_view family, int id);

}  // namespace fidservo::plant::view
