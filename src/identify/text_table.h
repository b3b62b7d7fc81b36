#pragma once
// Columns of numbers from a text table that somebody else made.
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fidservo {

/// Which column of a table plays which part: "input=1", "output=position [mm]" or "output=5[um]".
struct ColumnChoice {
    std::string role;
    std::string column;  ///< its number, from 1 on, or its title
    std::string unit;    ///< empty: that of the title, or what the reader expects
};

/// Reads "ROLE=COLUMN,ROLE=COLUMN[UNIT],...", as the option --columns takes it. Throws InputError on a role
/// that is not allowed or given twice, and if the first of `roles`, as many as are required, are not all
/// there.
std::vector<ColumnChoice> parse_columns(std::string_view text, std::span<const std::string_view> roles,
                                        std::size_t required);

struct TableColumn {
    std::string role;
    std::string unit;  ///< empty: not stated
    std::vector<double> values;
};

struct TextTable {
    std::filesystem::path file;
    std::vector<TableColumn> columns;

    /// nullptr if no column plays that part.
    const TableColumn* find(std::string_view role) const;
    std::size_t rows() const { return columns.front().values.size(); }
};

/// Reads a table: fields between commas, semicolons, tabs or blanks; a first line that is no row of numbers
/// holds the titles, a unit in brackets at their end. Throws InputError "FILE:LINE: ..." on a column that is
/// not there, a row of another length, a field that is no finite number, a last line that does not end.
TextTable read_text_table(const std::filesystem::path& file, const std::vector<ColumnChoice>& choices);

/// A column's values in a unit of the same quantity: mm um nm m; V mV; s ms us ns; degC; count adc. A column
/// without unit is taken to have it already. Throws InputError.
std::vector<double> values_in(const TextTable& table, std::string_view role, std::string_view unit);

}  // namespace fidservo
