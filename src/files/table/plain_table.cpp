// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/files/table/plain_table.h"

#include "core/input_error.h"
#include "src/files/table/decimal_decision.h"
#include "src/files/table/split_line.h"

#include <algorithm>

#include <fmt/format.h>

namespace fidservo {

PlainTable PlainTable::load(const std::filesystem::path& file, const TableOptions& options) {
    return parse(TextFile::load(file), options);
}

PlainTable PlainTable::parse(TextFile file, const TableOptions& options) {
    TableStructure structure = structure_of(file, options);
    PlainTable table(std::move(file), std::move(structure), options.are_offered);
    table.decide_decimal_sign(options);
    return table;
}

std::size_t PlainTable::columns() const {
    std::size_t columns = structure_.fields;
    while (columns > 0 && structure_.kinds[columns - 1] == FieldKind::empty) --columns;
    return columns;
}

void PlainTable::for_each_row(const std::function<void(const TableRow&)>& visit) const {
    std::vector<std::string_view> fields;
    for (TextLines lines(file_, structure_.first_row);
         lines.next() && lines.place().offset < structure_.end;) {
        const std::string_view line = lines.line();
        if (without_blanks(line).empty() || is_comment(line, structure_.separator)) continue;
        split_line(line, structure_.separator, fields);
        visit({lines.place().line, fields});
    }
}

void PlainTable::decide_decimal_sign(const TableOptions& options) {
    const char separator = structure_.separator;
    const DecimalEvidence evidence = decimal_evidence_of(*this, separator, columns());
    decimal_ = structure_.stated_decimal;
    const auto contradicts = [&](const DecimalEvidence::Place& place, DecimalSign sign) {
        if (place.line == 0 || decimal_ == sign || !decimal_) return;
        fail(place.line,
             fmt::format("'{}' is no number with a decimal {}", excerpt(place.field), name_of(*decimal_)));
    };
    contradicts(evidence.point, DecimalSign::point);
    contradicts(evidence.comma, DecimalSign::comma);
    if (evidence.point.line != 0 && evidence.comma.line != 0)
        fail(evidence.comma.line,
             fmt::format("'{}' has a decimal comma, but '{}' in line {} a decimal point",
                         excerpt(evidence.comma.field), excerpt(evidence.point.field), evidence.point.line));
    if (!decimal_ && evidence.point.line != 0) decimal_ = DecimalSign::point;
    if (!decimal_ && evidence.comma.line != 0) {
        decimal_ = DecimalSign::comma;
        structure_.notes.push_back(fmt::format("the comma is the decimal sign, as '{}' in line {} tells",
                                               excerpt(evidence.comma.field), evidence.comma.line));
    }
    if (separator != ',') return;
    constexpr std::string_view no_such_table =
        "a table with commas both between its fields and in its numbers cannot be read: "
        "save it with semicolons or tabs";
    if (decimal_ == DecimalSign::comma && evidence.comma.line == 0)
        fail(first_line(), fmt::format("commas stand between the fields; {}", no_such_table));
    const auto tells = [&](const TitleLine& titles) {
        const auto last = std::find_if(titles.fields.rbegin(), titles.fields.rend(),
                                       [](const std::string& title) { return !title.empty(); });
        return static_cast<std::size_t>(titles.fields.rend() - last) == columns();
    };
    if (!options.decimal && std::ranges::none_of(structure_.titles, tells) && columns() > 2)
        demand_whole_numbers(evidence, no_such_table);
    if (!decimal_ && evidence.has_point_between_commas) decimal_ = DecimalSign::point;
}

void PlainTable::demand_whole_numbers(const DecimalEvidence& evidence, std::string_view no_such_table) const {
    const std::string_view if_commas_separate =
        options_are_offered_ ? "if they only stand between fields: --decimal point; " : "";
    const auto ask = [&](const std::string& why) {
        fail(first_line(), fmt::format("the commas may stand between fields or in numbers: {}; {}{}", why,
                                       if_commas_separate, no_such_table));
    };
    if (evidence.could_be_thousands)
        ask(fmt::format("column {} could be the last digits of column {}", *evidence.could_be_thousands + 1,
                        *evidence.could_be_thousands));
    if (decimal_) return;
    const std::size_t titles = structure_.fields_above;
    if (titles > 1 && titles < columns() && columns() <= 2 * titles)
        ask(fmt::format("there are {} fields, but {} above them", columns(), titles));
    if (evidence.could_be_decimals)
        ask(fmt::format("column {} could be the decimals of column {}", *evidence.could_be_decimals + 1,
                        *evidence.could_be_decimals));
}

double PlainTable::number(const TableRow& row, std::size_t column) const {
    const std::string_view field = row.fields[column];
    const FieldLook look = look_at(field);
    if (!decimal_ && look.evidence == SignEvidence::point_or_group) {
        const auto by_point = number_of(field, DecimalSign::point),
                   by_comma = number_of(field, DecimalSign::comma);
        fail(row, column,
             fmt::format("could be {} or {}, and no number of the table tells{}", by_point.value_or(0.0),
                         by_comma.value_or(0.0),
                         options_are_offered_ ? ": say --decimal point or --decimal comma" : ""));
    }
    if (const auto value = number_of(field, decimal_.value_or(DecimalSign::point))) return *value;
    if (is_not_finite(field)) fail(row, column, "must be finite");
    if (look.kind == FieldKind::number)
        fail(row, column,
             fmt::format("must be a number with a decimal {}",
                         name_of(decimal_.value_or(DecimalSign::point))));
    fail(row, column, "must be a number");
}

void PlainTable::fail(const TableRow& row, std::size_t column, std::string_view message) const {
    fail(row.line, fmt::format("column {}: '{}': {}", column + 1, excerpt(row.fields[column]), message));
}

}  // namespace fidservo
