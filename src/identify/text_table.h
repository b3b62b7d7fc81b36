// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Columns of numbers from a text table of another program.
#include "src/files/table/table_structure.h"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fidservo {

/// The role of a table's column: "input=1", "output=position [mm]" or "output=5[um]".
struct ColumnChoice {
    std::string role;
    std::string column;  ///< its number, from 1 on, or its title with or without the unit
    std::string unit;    ///< empty: as the title states, or the default
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
    std::string perhaps = {};  ///< if no unit is stated: one that the title may mean, as x_m may
};

struct TextTable {
    std::filesystem::path file;
    std::vector<TableColumn> columns;
    std::vector<std::string> notes = {};  ///< sentences for the user: what was skipped, and what was decided

    /// The column with a role; nullptr if there is none.
    const TableColumn* find(std::string_view role) const;
    std::size_t rows() const { return columns.front().values.size(); }
};

/// Reads columns of a table that any program wrote (src/files/table/plain_table.h). A column's unit is the
/// choice's; else that of its title (column_units.h), or of the line of units below the titles. A column with
/// the role `time` may hold times of day (clock_time.h): they become seconds from the first row's. Throws
/// InputError "FILE:LINE: ..." on a column that is not there or that two titles mean, units that contradict
/// each other, a row of another length, a field of a chosen column that is no finite number or could be two.
TextTable read_text_table(const std::filesystem::path& file, const std::vector<ColumnChoice>& choices,
                          const TableOptions& options = {});

/// A column's values in a unit of the same quantity: mm um nm cm m; V mV uV; s ms us ns min; degC; count;
/// adc. A column without unit is taken to have it already. Throws InputError, also where the title may name
/// another one.
std::vector<double> values_in(const TextTable& table, std::string_view role, std::string_view unit);

}  // namespace fidservo
