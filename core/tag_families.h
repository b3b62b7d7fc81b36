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

/// A family of fiducials with a border of one cell. The tables are written at build time from those of
/// libapriltag and of OpenCV's ArUco module (write_tag_books.cpp).
struct TagFamily {
    std::string_view name;  ///< as its library has it: tag36h11, DICT_4X4_50
    int cells;              ///< a side of all that is printed, without the white paper around it
    int outline_cells;      ///< a side of the square whose corners are detected, and whose length is side_mm
    /// Bits in which two codes differ, or one and a turn of another or of itself, at least.
    int least_distance;
    /// Cells row by row from the upper left: 'b' black and 'w' white on every tag, 'd' of the code.
    std::string_view layout;
    /// Of every id; the cells 'd' in the order of the layout, the last one the lowest bit, 1 is white.
    std::span<const std::uint64_t> codes;

    /// How many tags it has.
    int size() const { return static_cast<int>(codes.size()); }
    /// All is inside the outline, and a black border just inside of it, which may be made wider.
    bool has_plain_border() const { return cells == outline_cells; }
};

/// All families: tag36h11, tag25h9, tag16h5, tagStandard41h12, then DICT_4X4_50 to DICT_7X7_1000.
std::span<const TagFamily> tag_families();

/// tag36h11: what is meant where nothing else is said.
const TagFamily& usual_tag_family();

/// Null if no family has this name.
const TagFamily* find_tag_family(std::string_view name);

/// How tags are printed.
struct TagPrint {
    const TagFamily* family = &usual_tag_family();  ///< whose code book
    int border_cells = 1;  ///< width of the border; 2 on a kalibr AprilGrid, for families with a plain border
    bool inverted = false;  ///< black is white, white is black, the paper around too

    bool operator==(const TagPrint&) const = default;

    /// Side of the outline in cells of the tag as it is printed.
    int outline_cells() const { return family->outline_cells + 2 * (border_cells - 1); }
    /// The side of all that is printed and of one cell of paper around it, in sides of the outline.
    double share_with_zone() const {
        return (family->cells + 2.0 * border_cells) / static_cast<double>(outline_cells());
    }
};

/// The place of a cell among those of a square, row by row from the upper left.
constexpr std::size_t cell_at(int row, int column, int cells_a_side) {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(cells_a_side) +
           static_cast<std::size_t>(column);
}

/// The cells of a tag, row by row from the upper left.
struct TagPattern {
    /// Side of the largest tag in cells, its rim included.
    static constexpr int most_cells = 11;

    int cells = 0;                               ///< a side of all that is printed
    int rim = 0;                                 ///< cells between its edge and the outline
    std::bitset<most_cells * most_cells> white;  ///< row by row, rim included
    std::bitset<most_cells * most_cells> code;   ///< the cells that tell the id
    bool paper_is_white = true;                  ///< around the tag
    bool corners_are_free = true;                ///< of black squares, which touch them on an AprilGrid

    /// By the cell's place in `white`.
    bool operator[](std::size_t cell) const { return white[cell]; }
    /// Side of the outline in cells.
    int outline_cells() const { return cells - 2 * rim; }
    /// Whether a cell is white.
    bool is_white(int row, int column) const { return white[cell_at(row, column, cells)]; }
    /// Whether it is white just inside the outline, and black just outside.
    bool is_white_inside() const { return is_white(rim, rim); }
};

/// What is printed for an id. Demands an id of the family, and a border of one cell, or two if it is plain.
TagPattern tag_pattern(const TagPrint& print, int tag_id);

/// "tag36h11", "tag25h9 with a border of two cells", "inverted tag16h5".
std::string text_of(const TagPrint& print);

}  // namespace fidservo
