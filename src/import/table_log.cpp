// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/import/table_log.h"

#include "core/input_error.h"
#include "src/files/table/clock_time.h"
#include "src/files/table/plain_table.h"
#include "src/identify/column_units.h"
#include "src/identify/units_above.h"
#include "src/import/interrupted.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <limits>
#include <optional>
#include <set>

#include <fmt/format.h>

namespace fidservo::imports {
namespace {

/// A column while it is read.
struct ReadColumn {
    std::size_t index = 0;
    FieldKind kind = FieldKind::number;
    LoggedSignal signal{};
    bool is_whole = true;           ///< all of its fields are integers without a point
    std::optional<int> decimals{};  ///< of its fields so far
    bool decimals_differ = false;
    std::optional<ClockTime> first{};  ///< of times of day
};

/// In a line of units, "-" stands for none.
bool is_name(const std::string& text) {
    return std::ranges::any_of(
        text, [](char letter) { return std::ispunct(static_cast<unsigned char>(letter)) == 0; });
}

/// The name and the unit that the lines above the rows give a column.
void name_column(const PlainTable& table, ReadColumn& column) {
    LoggedSignal& signal = column.signal;
    const auto& lines = table.titles();
    for (std::size_t k = 0; k < lines.size(); ++k) {
        if (column.index >= lines[k].fields.size()) continue;
        const std::string& field = lines[k].fields[column.index];
        const bool is_last = k + 1 >= lines.size() || column.index >= lines[k + 1].fields.size();
        const std::string alone = unit_alone(field);
        const ColumnTitleParts parts = title_parts(field);
        const std::string& unit = !alone.empty() && !is_last ? alone : parts.unit;
        if (!unit.empty() && !signal.unit.empty() && unit != signal.unit && signal.fault.empty())
            signal.fault = fmt::format("line {} gives it the unit '{}', but a line below '{}'", lines[k].line,
                                       unit, signal.unit);
        if (signal.unit.empty()) signal.unit = unit;
        if (signal.name.empty() && (alone.empty() || is_last) && is_name(parts.name))
            signal.name = parts.name;
    }
    if (signal.unit.empty() && signal.fault.empty()) signal.unit = unit_above(table, column.index).unit;
    if (signal.name.empty()) signal.name = fmt::format("{}", column.index + 1);
}

/// Titles that are there twice get the number of their column.
void make_names_unique(std::vector<ReadColumn>& columns) {
    std::multiset<std::string> names;
    for (const ReadColumn& column : columns) names.insert(column.signal.name);
    for (ReadColumn& column : columns)
        if (names.count(column.signal.name) > 1) column.signal.name += fmt::format("#{}", column.index + 1);
}

int decimals_of_field(std::string_view field) {
    const auto sign = field.find_last_of(".,");
    return sign == std::string_view::npos ? 0 : static_cast<int>(field.size() - sign) - 1;
}

void read_time_of_day(const TableRow& row, ReadColumn& column) {
    LoggedSignal& signal = column.signal;
    const auto time = clock_time_of(row.fields[column.index]);
    if (!column.first) column.first = time;
    if (!time || time->has_date != column.first->has_date) {
        signal.fault = fmt::format("line {}: '{}' is no time of day as those of other rows", row.line,
                                   excerpt(row.fields[column.index]));
        return;
    }
    if (!time->is_date_certain && time->date != column.first->date) {
        signal.fault = fmt::format("line {}: in '{}' day and month could be exchanged, and the date changes",
                                   row.line, excerpt(row.fields[column.index]));
        return;
    }
    signal.whole.push_back(time->ns - column.first->ns);
    signal.values.push_back(static_cast<double>(signal.whole.back()));
}

void read_number(const PlainTable& table, const TableRow& row, ReadColumn& column) {
    LoggedSignal& signal = column.signal;
    const std::string_view field = without_blanks(row.fields[column.index]);
    if (look_at(field).kind == FieldKind::empty) {
        signal.values.push_back(std::numeric_limits<double>::quiet_NaN());
        column.is_whole = false;
        return;
    }
    try {
        signal.values.push_back(table.number(row, column.index));
    } catch (const InputError& error) {
        const std::string file = table.file().string() + ":";
        const std::string text = error.what();
        signal.fault = "line " + (text.starts_with(file) ? text.substr(file.size()) : text);
        return;
    }
    const int decimals = decimals_of_field(field);
    column.decimals_differ = column.decimals_differ || (column.decimals && *column.decimals != decimals) ||
                             field.find_first_of("eEdD") != std::string_view::npos;
    column.decimals = decimals;
    std::int64_t whole = 0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), whole);
    column.is_whole = column.is_whole && error == std::errc() && end == field.data() + field.size();
    if (column.is_whole) signal.whole.push_back(whole);
}

void finish(ReadColumn& column) {
    LoggedSignal& signal = column.signal;
    if (!signal.fault.empty()) signal.values.clear();
    if (!signal.fault.empty() || !column.is_whole) signal.whole.clear();
    if (column.kind == FieldKind::time) signal.unit = "ns";
    if (column.kind == FieldKind::number && column.decimals && !column.decimals_differ)
        signal.decimals = *column.decimals;
}

}  // namespace

Log read_table_log(const std::filesystem::path& file, const TableOptions& options) {
    const PlainTable table = PlainTable::load(file, options);
    demand_no_factors(table);
    Log log{.file = file, .notes = table.notes()};
    if (!table.last_row_ends())
        log.notes.emplace_back(
            "the last line has no end: if the file was cut off, its last number is too short");
    std::vector<ReadColumn> columns;
    for (std::size_t k = 0; k < table.columns(); ++k) {
        const FieldKind kind = table.kind(k);
        if (kind != FieldKind::number && kind != FieldKind::time && kind != FieldKind::empty) continue;
        columns.push_back({.index = k, .kind = kind});
        name_column(table, columns.back());
    }
    make_names_unique(columns);
    std::uint64_t values = 0;
    table.for_each_row([&](const TableRow& row) {
        end_if_interrupted();
        values += columns.size();
        if (values > most_values)
            throw InputError(fmt::format("{}: more than {} numbers: are not read from one file",
                                         file.string(), most_values));
        for (ReadColumn& column : columns) {
            if (!column.signal.fault.empty()) continue;
            if (column.kind == FieldKind::time)
                read_time_of_day(row, column);
            else
                read_number(table, row, column);
        }
    });
    for (ReadColumn& column : columns) {
        finish(column);
        log.signals.push_back(std::move(column.signal));
    }
    return log;
}

}  // namespace fidservo::imports
