// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Units of a table's columns, as written in titles.
#include <string>
#include <string_view>
#include <vector>

namespace fidservo {

struct Unit {
    std::string_view name;
    std::string_view quantity;
    double size;  ///< its size in the first unit of its quantity
};

/// With a to z in place of A to Z.
std::string in_small_letters(std::string text);

/// By a unit's name, or another way to write it: "µm", "micron", "sec", "Volts", "°C". nullptr if it is
/// unknown.
const Unit* find_unit(std::string_view text);

/// The names of a quantity's units.
std::vector<std::string_view> units_of(std::string_view quantity);

/// A column's title, split into name and unit.
struct ColumnTitleParts {
    std::string name;     ///< without the unit
    std::string unit;     ///< find_unit()'s name for it, or as written if that does not know it; else empty
    std::string perhaps;  ///< a unit that the title may name: t_s may mean s, or a name that begins with s
};

/// A unit stands at the end in square brackets. If it is some quantity's it may also stand there in others,
/// behind a stroke, a comma or the word in, or in brackets anywhere: "position [mm]", "Position (mm)",
/// "s/mm", "x, mm", "x in mm", "[mm] x". Behind an underscore, a point or a blank it is one if it has two
/// letters: "x_mm", "x mm".
ColumnTitleParts title_parts(std::string_view title);

/// The units that a line names: in brackets of any kind, between commas, semicolons, bars, tabs, colons or
/// equals signs, and, if the line speaks of units, between blanks.
std::vector<std::string> units_named_in(std::string_view line);

/// The unit, of any quantity, if a text consists of nothing else, as in a line of units below the titles:
/// find_unit()'s name, or the text; empty if it is none.
std::string unit_alone(std::string_view text);

}  // namespace fidservo
