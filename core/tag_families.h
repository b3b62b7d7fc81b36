// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The code books of fiducials: what is printed for every id.
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace fidservo {

/// A family of fiducials with a border of one cell. Its tables are generated at build time from libapriltag
/// and OpenCV's ArUco module (write_tag_books.cpp).
struct TagFamily {
    std::string_view name;  ///< as its library calls it: tag36h11, DICT_4X4_50
    int cells;              ///< cells along a side of all that is printed, without the white paper around it
    /// Cells along a side of the square whose corners are detected; side_mm is this square's.
    int outline_cells;
    /// The family's minimum Hamming distance, over all rotations of the codes: a code's distance from its own
    /// rotations counts too.
    int least_distance;
    /// The cells row by row from the upper left: 'b' is black and 'w' white on every tag, 'd' is a bit of the
    /// code.
    std::string_view layout;
    /// The code of every id. The bits are the cells 'd' in the order of the layout; the last one is the
    /// lowest bit; 1 is white.
    std::span<const std::uint64_t> codes;

    /// How many tags it has.
    int size() const { return static_cast<int>(codes.size()); }
    /// Whether everything printed is inside the outline, with a black border just inside of it. Such a border
    /// may be made wider.
    bool has_plain_border() const { return cells == outline_cells; }
};

/// All families: tag36h11, tag25h9, tag16h5, tagStandard41h12, then DICT_4X4_50 to DICT_7X7_1000.
std::span<const TagFamily> tag_families();

/// tag36h11, the default family.
const TagFamily& usual_tag_family();

/// Null if no family has this name.
const TagFamily* find_tag_family(std::string_view name);

/// How tags are printed.
struct TagPrint {
    const TagFamily* family = &usual_tag_family();  ///< the family, which is the code book
    /// Width of the border in cells; 2 on a kalibr AprilGrid, for families with a plain border.
    int border_cells = 1;
    bool inverted = false;  ///< black and white are exchanged, also those of the paper around the tag

    bool operator==(const TagPrint&) const = default;

    /// Side of the outline in cells of the tag as it is printed.
    int outline_cells() const { return family->outline_cells + 2 * (border_cells - 1); }
    /// The side of what is printed together with one cell of paper around it, in units of the outline's side.
    double share_with_zone() const {
        return (family->cells + 2.0 * border_cells) / static_cast<double>(outline_cells());
    }
};

/// The index of a cell in a square's list of cells, row by row from the upper left.
constexpr std::size_t cell_at(int row, int column, int cells_a_side) {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(cells_a_side) +
           static_cast<std::size_t>(column);
}

/// The cells of a tag, row by row from the upper left.
struct TagPattern {
    /// Side in cells of the largest tag, including the cells outside of its outline.
    static constexpr int most_cells = 11;

    int cells = 0;  ///< cells along a side of all that is printed
    int rim = 0;    ///< cells between the edge of the print and the outline
    /// Which cells are white, row by row, those outside of the outline included.
    std::bitset<most_cells * most_cells> white;
    std::bitset<most_cells * most_cells> code;  ///< which cells carry bits of the code
    bool paper_is_white = true;                 ///< whether the paper around the tag is white
    bool corners_are_free = true;  ///< no black squares touch the tag's corners, as they do on an AprilGrid

    /// Whether a cell is white, by its index as of cell_at().
    bool operator[](std::size_t cell) const { return white[cell]; }
    /// Side of the outline in cells.
    int outline_cells() const { return cells - 2 * rim; }
    /// Whether a cell is white.
    bool is_white(int row, int column) const { return white[cell_at(row, column, cells)]; }
    /// Whether the cells just inside the outline are white, and those just outside black.
    bool is_white_inside() const { return is_white(rim, rim); }
};

/// The cells that are printed for an id. Demands an id of the family, and a border of one cell, or of two if
/// the family's border is plain.
TagPattern tag_pattern(const TagPrint& print, int tag_id);

/// What a tag is called: "tag36h11", "tag25h9 with a border of two cells", "inverted tag16h5".
std::string text_of(const TagPrint& print);

}  // namespace fidservo
