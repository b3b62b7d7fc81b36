// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/view/tag_code.h"

#include "core/input_error.h"
#include "core/tag_families.h"

#include <string>

namespace fidservo::plant::view {

PrintedTag printed_tag(const PlateTag& tag) {
    const TagFamily& family = *tag.print.family;
    if (tag.id < 0 || tag.id >= family.size()) {
        throw InputError("plate: tag id " + std::to_string(tag.id) + " is not in " +
                         std::string(family.name) + "; allowed: 0.." + std::to_string(family.size() - 1));
    }
    const TagPattern cells = tag_pattern(tag.print, tag.id);
    const int sheet = cells.paper_is_white ? 0 : 1;
    const int side = cells.cells + 2 * sheet;
    CellPattern pattern{side, side, std::vector<std::uint8_t>(cell_at(side, 0, side), 1)};
    for (int row = 0; row < cells.cells; ++row) {
        for (int column = 0; column < cells.cells; ++column) {
            if (cells.is_white(row, column)) pattern.inked[cell_at(row + sheet, column + sheet, side)] = 0;
        }
    }
    return {pattern, tag.side_mm * side / cells.outline_cells()};
}

}  // namespace fidservo::plant::view
