// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/tag_families.h"

#include "core/demand.h"

#include <algorithm>

namespace fidservo {

const TagFamily& usual_tag_family() {
    return tag_families().front();
}

const TagFamily* find_tag_family(std::string_view name) {
    const auto families = tag_families();
    const auto found = std::ranges::find(families, name, &TagFamily::name);
    return found == families.end() ? nullptr : &*found;
}

TagPattern tag_pattern(const TagPrint& print, int tag_id) {
    const TagFamily& family = *print.family;
    FIDSERVO_DEMAND(tag_id >= 0 && tag_id < family.size());
    FIDSERVO_DEMAND(print.border_cells == 1 || (print.border_cells == 2 && family.has_plain_border()));
    const int wider = print.border_cells - 1;
    TagPattern pattern{.cells = family.cells + 2 * wider,
                       .rim = (family.cells - family.outline_cells) / 2,
                       .white = {},
                       .code = {},
                       .paper_is_white = !print.inverted,
                       .corners_are_free = print.border_cells == 1};
    const std::uint64_t code = family.codes[static_cast<std::size_t>(tag_id)];
    auto bits = static_cast<int>(std::ranges::count(family.layout, 'd'));
    for (int row = 0; row < family.cells; ++row)
        for (int column = 0; column < family.cells; ++column) {
            const char cell = family.layout[cell_at(row, column, family.cells)];
            const std::size_t at = cell_at(row + wider, column + wider, pattern.cells);
            pattern.code[at] = cell == 'd';
            pattern.white[at] = cell == 'd' ? ((code >> --bits) & 1U) != 0 : cell == 'w';
        }
    if (print.inverted)
        for (int cell = 0; cell < pattern.cells * pattern.cells; ++cell)
            pattern.white.flip(static_cast<std::size_t>(cell));
    return pattern;
}

std::string text_of(const TagPrint& print) {
    return (print.inverted ? "inverted " : "") + std::string(print.family->name) +
           (print.border_cells == 2 ? " with a border of two cells" : "");
}

}  // namespace fidservo
