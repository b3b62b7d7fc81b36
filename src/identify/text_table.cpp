// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/identify/text_table.h"

#include "core/demand.h"
#include "core/input_error.h"
#include "src/files/table/clock_time.h"
#include "src/files/table/plain_table.h"
#include "src/identify/column_units.h"

#include <algorithm>
#include <charconv>
#include <functional>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo {

namespace {

/// "5[um]" and "position [mm]" have a unit.
ColumnChoice choice_of(std::string role, std::string_view text) {
    text = without_blanks(text);
    const auto open = text.rfind('[');
    if (open == std::string_view::npos || !text.ends_with(']'))
        return {std::move(role), std::string(text), ""};
    return {std::move(role), std::string(without_blanks(text.substr(0, open))),
            std::string(text.substr(open + 1, text.size() - open - 2))};
}

std::optional<std::size_t> column_number(std::string_view text) {
    std::size_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return number;
}

/// The columns that a title means.
std::vector<std::size_t> columns_titled(const PlainTable& table, std::string_view title) {
    for (const TitleLine& line : table.titles()) {
        std::vector<std::size_t> found;
        for (std::size_t k = 0; k < std::min(line.fields.size(), table.columns()); ++k)
            if (without_blanks(line.fields[k]) == title || title_parts(line.fields[k]).name == title)
                found.push_back(k);
        if (!found.empty()) return found;
    }
    return {};
}

std::string titles_for_message(const PlainTable& table) {
    constexpr std::size_t most_named = 30;
    std::vector<std::string> names;
    for (const TitleLine& line : table.titles())
        for (const std::string& field : line.fields)
            if (const std::string name = title_parts(field).name; !name.empty() && names.size() < most_named)
                names.push_back(excerpt(name));
    return names.empty() ? "" : fmt::format(", {}", fmt::join(names, ", "));
}

/// The index of a chosen column.
std::size_t find_column(const PlainTable& table, const ColumnChoice& choice) {
    const auto fail = [&](const std::string& message) {
        throw InputError(fmt::format("{}: --columns: {}={}: {}", table.file().string(), choice.role,
                                     choice.column, message));
    };
    std::vector<std::size_t> found = columns_titled(table, choice.column);
    const auto number = column_number(choice.column);
    const bool is_number = number && *number >= 1 && *number <= table.columns();
    if (is_number && std::ranges::any_of(found, [&](std::size_t k) { return k + 1 != *number; }))
        fail(fmt::format(
            "is the number of one column and the title of column {}; give the number of the other, or "
            "its title in another line",
            found.front() + 1));
    if (is_number) return *number - 1;
    if (found.empty())
        fail(fmt::format("no such column; allowed: 1 to {}{}", table.columns(), titles_for_message(table)));
    if (found.size() > 1)
        fail(fmt::format("is the title of columns {} and {}; give the number", found[0] + 1, found[1] + 1));
    return found.front();
}

/// Times of day in seconds from the first row's.
class ClockColumn {
  public:
    ClockColumn(const PlainTable& table, std::size_t column) : table_(&table), column_(column) {}

    double seconds_at(const TableRow& row) {
        const auto time = clock_time_of(row.fields[column_]);
        if (!time) table_->fail(row, column_, "must be a time of day as those of other rows");
        if (!has_first_) {
            has_first_ = true;
            first_ = *time;
            first_date_ = time->date;
        }
        if (time->has_date != first_.has_date)
            table_->fail(row, column_, "must have a date in all rows or in none");
        if (time->date != first_date_ && !(time->is_date_certain && first_.is_date_certain))
            table_->fail(
                row, column_,
                "day and month could be exchanged; allowed over more than one day: dates as 2020-04-03");
        return static_cast<double>(time->ns - first_.ns) * 1e-9;
    }

  private:
    const PlainTable* table_;
    std::size_t column_;
    bool has_first_ = false;
    ClockTime first_;
    std::string first_date_;
};

/// A chosen column, where it stands and how it is read.
struct Reading {
    std::size_t index;
    std::optional<ClockColumn> clock;
};

Reading reading_of(const PlainTable& table, const ColumnChoice& choice, TableColumn& column) {
    Reading reading{find_column(table, choice), std::nullopt};
    const Unit* stated = find_unit(choice.unit);
    column.unit = stated != nullptr ? std::string(stated->name) : choice.unit;
    if (table.kind(reading.index) == FieldKind::time && choice.role == "time") {
        if (!column.unit.empty() && column.unit != "s")
            table.fail(table.first_line(),
                       fmt::format("column {}: holds times of day, which have no unit '{}'",
                                   reading.index + 1, choice.unit));
        column.unit = "s";
        reading.clock.emplace(table, reading.index);
    } else if (column.unit.empty()) {
        UnitAbove found = unit_above(table, reading.index);
        column.unit = std::move(found.unit);
        column.possible = std::move(found.possible);
    }
    return reading;
}

}  // namespace

std::vector<ColumnChoice> parse_columns(std::string_view text, std::span<const std::string_view> roles,
                                        std::size_t required) {
    const auto fail = [&](const std::string& message) {
        throw InputError(fmt::format("--columns: {}: {}; allowed: ROLE=COLUMN,... with the roles {}", text,
                                     message, fmt::join(roles, ", ")));
    };
    std::vector<ColumnChoice> choices;
    for (std::string_view rest = text; !rest.empty();) {
        const std::string_view piece = rest.substr(0, rest.find(','));
        rest.remove_prefix(std::min(rest.size(), piece.size() + 1));
        const auto equals = piece.find('=');
        if (equals == std::string_view::npos) fail(fmt::format("'{}' is not ROLE=COLUMN", piece));
        const std::string role(without_blanks(piece.substr(0, equals)));
        ColumnChoice choice = choice_of(role, piece.substr(equals + 1));
        if (std::ranges::find(roles, role) == roles.end()) fail(fmt::format("'{}' is no role", role));
        if (std::ranges::find(choices, role, &ColumnChoice::role) != choices.end())
            fail(fmt::format("{} is given twice", role));
        if (choice.column.empty()) fail(fmt::format("{} has no column", role));
        choices.push_back(std::move(choice));
    }
    for (const std::string_view role : roles.first(required))
        if (std::ranges::find(choices, role, &ColumnChoice::role) == choices.end())
            fail(fmt::format("{} is missing", role));
    return choices;
}

const TableColumn* TextTable::find(std::string_view role) const {
    const auto found = std::ranges::find(columns, role, &TableColumn::role);
    return found == columns.end() ? nullptr : &*found;
}

TextTable read_text_table(const std::filesystem::path& file, const std::vector<ColumnChoice>& choices,
                          const TableOptions& options) {
    FIDSERVO_DEMAND(!choices.empty());
    const PlainTable source = PlainTable::load(file, options);
    demand_no_factors(source);
    TextTable table{file, {}, source.notes()};
    if (!source.last_row_ends())
        table.notes.emplace_back(
            "the last line has no end: if the file was cut off, its last number is too short");
    std::vector<Reading> readings;
    for (const ColumnChoice& choice : choices) {
        table.columns.push_back({choice.role, "", {}, choice.column});
        readings.push_back(reading_of(source, choice, table.columns.back()));
    }
    source.for_each_row([&](const TableRow& row) {
        for (std::size_t i = 0; i < readings.size(); ++i) {
            Reading& reading = readings[i];
            table.columns[i].values.push_back(reading.clock ? reading.clock->seconds_at(row)
                                                            : source.number(row, reading.index));
        }
    });
    return table;
}

void demand_no_other_unit(const TextTable& table, std::string_view role,
                          const std::function<bool(const Unit&)>& is_other, std::string_view usual) {
    const TableColumn* column = table.find(role);
    FIDSERVO_DEMAND(column != nullptr);
    if (!column->unit.empty()) return;
    for (const PossibleUnit& possible : column->possible)
        if (is_other(*find_unit(possible.unit)))
            throw InputError(fmt::format(
                "{}:{}: {}: '{}' may name its unit, {}, or not: say it in --columns, as {}={}[{}] or [{}]",
                table.file.string(), possible.line, role, possible.text, possible.unit, role, column->column,
                possible.unit, usual));
}

std::vector<double> values_in(const TextTable& table, std::string_view role, std::string_view unit) {
    const TableColumn* column = table.find(role);
    const Unit* wanted = find_unit(unit);
    FIDSERVO_DEMAND(column != nullptr && wanted != nullptr);
    demand_no_other_unit(
        table, role,
        [&](const Unit& other) { return other.quantity == wanted->quantity && other.size != wanted->size; },
        unit);
    if (column->unit.empty() || column->unit == unit) return column->values;
    const Unit* given = find_unit(column->unit);
    if (given == nullptr || given->quantity != wanted->quantity)
        throw InputError(fmt::format("{}: {}: unit '{}': allowed: {}", table.file.string(), role,
                                     column->unit, fmt::join(units_of(wanted->quantity), ", ")));
    std::vector<double> values = column->values;
    for (double& value : values) value *= given->size / wanted->size;
    return values;
}

}  // namespace fidservo
