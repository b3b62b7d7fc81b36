// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Where in a text file a table stands: what separates its fields, where its rows begin and end, which lines
// above them hold titles.
#include "src/files/table/number_notation.h"
#include "src/files/table/text_file.h"

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fidservo {

/// What the user says of a table; what is not said is found, or asked for.
struct TableOptions {
    std::optional<int> header_lines = {};
    std::optional<DecimalSign> decimal = {};
    std::optional<char> separator = {};  ///< ' ' stands for blanks and tabs, many as one
    bool are_offered = true;             ///< whether messages may name the options that say the above
};

/// A line above the rows with a field for each column.
struct TitleLine {
    int line;
    std::vector<std::string> fields;
};

struct TableStructure {
    char separator = ',';
    std::size_t fields = 0;             ///< of every row
    std::vector<FieldKind> kinds = {};  ///< of the columns, by what most of their fields are
    LinePlace first_row = {};
    std::size_t end = 0;                                         ///< offset behind the last row
    int last_line = 0;                                           ///< the last row's
    std::vector<TitleLine> titles = {};                          ///< the lowest first
    std::optional<std::pair<int, std::string>> line_above = {};  ///< the lowest, where none is one of titles
    std::size_t fields_above = 0;                    ///< of the lowest line above the rows; 0 without one
    std::optional<DecimalSign> stated_decimal = {};  ///< by the user, or by a line above the rows
    std::vector<std::string> notes = {};             ///< sentences on what was passed over
};

inline constexpr std::size_t most_table_columns = 10'000;

/// The separator is the one by which most fields are numbers. Rows are the last lines of the file that have
/// as many fields and a number each; the first of them is the first without text in a column of numbers.
/// Blank lines and comments (split_line.h) are passed over. What stands above is no row, or else the file is
/// refused: a row of numbers above a line of text, a line of numbers with another count of fields, a line
/// between titles and rows that has both. Lines of text below the rows are passed over, and said.
/// @throws InputError "FILE:LINE: ..."
TableStructure structure_of(const TextFile& file, const TableOptions& options);

/// How messages call a separator.
std::string_view separator_name(char separator);

/// A piece of a file for a message, without quotes of its own and not too long.
std::string excerpt(std::string_view text);

[[noreturn]] void fail_in_line(const TextFile& file, int line, std::string_view message);

}  // namespace fidservo
