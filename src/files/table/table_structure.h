// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The structure of a table in a text file: its separator, where its rows begin and end, and which lines above
// them hold titles.
#include "src/files/table/number_notation.h"
#include "src/files/table/text_file.h"

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fidservo {

/// What the user states about a table; the rest is detected, or an error asks for it.
struct TableOptions {
    std::optional<int> header_lines = {};
    std::optional<DecimalSign> decimal = {};
    std::optional<char> separator = {};  ///< ' ' stands for any run of blanks and tabs
    bool are_offered = true;             ///< whether messages may mention the options that state the above
};

/// A line above the rows with a field for each column.
struct TitleLine {
    int line;
    std::vector<std::string> fields;
};

/// Any line above the rows.
struct LineAbove {
    int line = 0;
    std::string text = {};
    std::vector<std::string> fields = {};  ///< one for each column, if the line has as many and text in them
    bool has_number = false;               ///< whether some of them are numbers
};

struct TableStructure {
    char separator = ',';
    std::size_t fields = 0;             ///< number of fields in every row
    std::vector<FieldKind> kinds = {};  ///< kinds of the columns, by the majority of their fields
    LinePlace first_row = {};
    std::size_t end = 0;                 ///< offset behind the last row
    int last_line = 0;                   ///< number of the last row's line
    std::vector<TitleLine> titles = {};  ///< the lowest first
    std::vector<LineAbove> above = {};   ///< titles and all other lines above the rows, the lowest first
    std::size_t fields_above = 0;        ///< fields of the lowest line above the rows; 0 without one
    std::optional<DecimalSign> stated_decimal = {};  ///< stated by the user, or in a line above the rows
    std::vector<std::string> notes = {};             ///< sentences on what was skipped
};

inline constexpr std::size_t most_table_columns = 10'000;

/// The separator is the one by which most fields are numbers. Rows are the last lines of the file that have
/// as many fields and a number each; the first of them is the first without text in a column of numbers.
/// Blank lines and comments (split_line.h) are passed over. What stands above is no row, or else the file is
/// refused: a row of numbers above a line of text, a line of numbers with another count of fields, a line
/// between titles and rows that has both. Lines of text below the rows are passed over, and said.
/// @throws InputError "FILE:LINE: ..."
TableStructure structure_of(const TextFile& file, const TableOptions& options);

/// The name of a separator in messages.
std::string_view separator_name(char separator);

/// A piece of a file for a message, without quotes of its own and not too long.
std::string excerpt(std::string_view text);

[[noreturn]] void fail_in_line(const TextFile& file, int line, std::string_view message);

}  // namespace fidservo
