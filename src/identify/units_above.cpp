// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/identify/units_above.h"

#include "src/identify/column_units.h"

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>

namespace fidservo {

namespace {

/// Whether a line has two fields or more that are units, and no other ones but "-", which stands for none.
bool is_line_of_units(const LineAbove& line) {
    const auto stated = std::ranges::count_if(
        line.fields, [](const std::string& field) { return !unit_alone(field).empty(); });
    return stated >= 2 && std::ranges::all_of(line.fields, [](const std::string& field) {
               return field.empty() || field == "-" || !unit_alone(field).empty();
           });
}

bool has_title(const LineAbove& line, std::size_t column) {
    return column < line.fields.size() && unit_alone(line.fields[column]).empty() &&
           look_at(line.fields[column]).kind == FieldKind::text;
}

/// Collects what lines say of one column.
class UnitSearch {
  public:
    UnitSearch(const PlainTable& table, std::size_t column) : table_(&table), column_(column) {
        for (const LineAbove& line : table.above())
            if (!line.fields.empty()) lines_.push_back(&line);
    }

    UnitAbove found() {
        for (std::size_t k = 0; k < lines_.size(); ++k)
            if (column_ < lines_[k]->fields.size() && can_name_columns(*lines_[k])) look_in(k);
        for (const LineAbove& line : table_->above())
            if (line.fields.empty() || !can_name_columns(line) ||
                !(is_of_titles(line) || is_line_of_units(line)))
                for (const std::string& unit : units_named_in(line.text)) add_possible(unit, line, line.text);
        return std::move(unit_);
    }

  private:
    bool is_of_titles(const LineAbove& line) const {
        const auto& titles = table_->titles();
        return std::ranges::find(titles, line.line, &TitleLine::line) != titles.end();
    }

    /// A line with numbers above the titles is the instrument's own.
    bool can_name_columns(const LineAbove& line) const { return !line.has_number || is_of_titles(line); }

    void look_in(std::size_t k) {
        const LineAbove& line = *lines_[k];
        const std::string& field = line.fields[column_];
        const std::string alone = unit_alone(field);
        const ColumnTitleParts parts = title_parts(field);
        // Above the titles an instrument says of itself, field by field: Horizontal Units,s.
        const bool is_below_a_title =
            is_of_titles(line) && k + 1 < lines_.size() && has_title(*lines_[k + 1], column_);
        // A title alone may be a word that is also a unit's.
        const bool stands_for_a_unit = is_below_a_title || (lines_.size() > 1 && is_line_of_units(line));
        state(!alone.empty() && stands_for_a_unit ? alone : parts.unit, line);
        add_possible(parts.perhaps, line, field);
        add_possible(alone, line, field);
    }

    void state(const std::string& unit, const LineAbove& line) {
        if (unit.empty()) return;
        if (unit_.unit.empty()) {
            unit_.unit = unit;
            line_of_unit_ = line.line;
        } else if (unit_.unit != unit && is_of_titles(line)) {
            table_->fail(line.line,
                         fmt::format("column {}: unit '{}', but '{}' in line {}: say which in --columns",
                                     column_ + 1, unit, unit_.unit, line_of_unit_));
        }
    }

    void add_possible(const std::string& unit, const LineAbove& line, std::string_view text) {
        if (find_unit(unit) != nullptr) unit_.possible.push_back({unit, line.line, excerpt(text)});
    }

    const PlainTable* table_;
    std::size_t column_;
    std::vector<const LineAbove*> lines_;  ///< those with a field for each column, the lowest first
    UnitAbove unit_;
    int line_of_unit_ = 0;
};

bool is_word_for_a_factor(std::string_view field) {
    constexpr std::array<std::string_view, 5> words{"scale", "scaling", "factor", "gain", "multiplier"};
    return std::ranges::find(words, in_small_letters(std::string(without_blanks(field)))) != words.end();
}

}  // namespace

void demand_no_factors(const PlainTable& table) {
    for (const LineAbove& line : table.above()) {
        const auto numbers = std::ranges::count_if(
            line.fields, [](const std::string& field) { return look_at(field).kind == FieldKind::number; });
        if (numbers < 2 || !is_word_for_a_factor(line.fields.front())) continue;
        table.fail(line.line, fmt::format("'{}' gives the columns factors, which are not applied: multiply "
                                          "the columns by them and remove the line",
                                          excerpt(line.text)));
    }
}

UnitAbove unit_above(const PlainTable& table, std::size_t column) {
    return UnitSearch(table, column).found();
}

}  // namespace fidservo
