// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Columns of numbers from a text table of another program.
#include "src/files/table/table_structure.h"
#include "src/identify/column_units.h"
#include "src/identify/units_above.h"

#include <filesystem>
#include <functional>
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
    std::string column = {};                  ///< as the user chose it: its number or its title
    std::vector<PossibleUnit> possible = {};  ///< if no unit is stated
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
/// choice's; else that of the lines above the rows (units_above.h). A column with
/// the role `time` may hold times of day (clock_time.h): they become seconds from the first row's. Throws
/// InputError "FILE:LINE: ..." on a column that is not there or that two titles mean, units that contradict
/// each other, a row of another length, a field of a chosen column that is no finite number or could be two.
TextTable read_text_table(const std::filesystem::path& file, const std::vector<ColumnChoice>& choices,
                          const TableOptions& options = {});

/// Throws InputError, which asks for the unit, if no unit of a column is stated and a line above the rows
/// names one that may be its, and is another than the usual one.
void demand_no_other_unit(const TextTable& table, std::string_view role,
                          const std::function<bool(const Unit&)>& is_other, std::string_view usual);

/// A column's values in a unit of the same quantity: mm um nm cm m; V mV uV; s ms us ns min h day; degC;
/// count; adc. A column without unit is taken to have it already. Throws InputError, also where a line above
/// the rows may name another one.
std::vector<double> values_in(const TextTable& table, std::string_view role, std::string_view unit);

}  // namespace fidservo
