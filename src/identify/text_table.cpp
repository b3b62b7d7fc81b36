#include "src/identify/text_table.h"

#include "core/demand.h"
#include "core/input_error.h"
#include "src/recording/csv_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo {

namespace {

struct Title {
    std::string name;
    std::string unit;
};

std::string_view trimmed(std::string_view text) {
    const auto first = text.find_first_not_of(" \t#");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// "position [mm]" and "5[um]" have a unit.
Title title_of(std::string_view text) {
    text = trimmed(text);
    const auto open = text.rfind('[');
    if (open == std::string_view::npos || !text.ends_with(']')) return {std::string(text), ""};
    return {std::string(trimmed(text.substr(0, open))),
            std::string(text.substr(open + 1, text.size() - open - 2))};
}

bool is_number(std::string_view text) {
    double value = 0.0;
    if (text.starts_with('+')) text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size();
}

std::optional<std::size_t> column_number(std::string_view text) {
    std::size_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return number;
}

struct Unit {
    std::string_view name;
    std::string_view quantity;
    double size;
};

constexpr std::array units{
    Unit{"mm", "length", 1.0},  Unit{"um", "length", 1e-3},       Unit{"nm", "length", 1e-6},
    Unit{"m", "length", 1e3},   Unit{"V", "voltage", 1.0},        Unit{"mV", "voltage", 1e-3},
    Unit{"s", "time", 1.0},     Unit{"ms", "time", 1e-3},         Unit{"us", "time", 1e-6},
    Unit{"ns", "time", 1e-9},   Unit{"degC", "temperature", 1.0}, Unit{"count", "count", 1.0},
    Unit{"adc", "reading", 1.0}};

const Unit* find_unit(std::string_view name) {
    const auto found = std::ranges::find(units, name, &Unit::name);
    return found == units.end() ? nullptr : &*found;
}

/// The index of a chosen column.
std::size_t find_column(const CsvText& csv, const std::vector<Title>& titles, const ColumnChoice& choice) {
    const auto found = std::ranges::find(titles, choice.column, &Title::name);
    if (found != titles.end()) return static_cast<std::size_t>(found - titles.begin());
    const auto number = column_number(choice.column);
    if (number && *number >= 1 && *number <= titles.size()) return *number - 1;
    std::vector<std::string> names;
    for (const Title& title : titles)
        if (!title.name.empty()) names.push_back(title.name);
    csv.fail(fmt::format("--columns: {}={}: no such column; allowed: 1 to {}{}", choice.role, choice.column,
                         titles.size(), names.empty() ? "" : fmt::format(", {}", fmt::join(names, ", "))));
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
        const Title column = title_of(piece.substr(equals + 1));
        const std::string role(trimmed(piece.substr(0, equals)));
        if (std::ranges::find(roles, role) == roles.end()) fail(fmt::format("'{}' is no role", role));
        if (std::ranges::find(choices, role, &ColumnChoice::role) != choices.end())
            fail(fmt::format("{} is given twice", role));
        if (column.name.empty()) fail(fmt::format("{} has no column", role));
        choices.push_back({role, column.name, column.unit});
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

TextTable read_text_table(const std::filesystem::path& file, const std::vector<ColumnChoice>& choices) {
    FIDSERVO_DEMAND(!choices.empty());
    CsvText csv = CsvText::load(file, Separator::of_first_line);
    if (!csv.next()) csv.fail("there is no row");
    bool is_row = std::ranges::all_of(csv.fields(), is_number);
    std::vector<Title> titles(csv.fields().size());
    if (!is_row) std::ranges::transform(csv.fields(), titles.begin(), title_of);

    TextTable table{file, {}};
    std::vector<std::size_t> indices;
    for (const ColumnChoice& choice : choices) {
        indices.push_back(find_column(csv, titles, choice));
        table.columns.push_back(
            {choice.role, choice.unit.empty() ? titles[indices.back()].unit : choice.unit, {}});
    }
    for (; is_row || csv.next(); is_row = false) {
        if (csv.fields().size() != titles.size())
            csv.fail(fmt::format("has {} fields; the first line has {}", csv.fields().size(), titles.size()));
        for (std::size_t i = 0; i < indices.size(); ++i)
            table.columns[i].values.push_back(csv.number(indices[i]));
    }
    if (table.rows() == 0) csv.fail("there is no row below the titles");
    return table;
}

std::vector<double> values_in(const TextTable& table, std::string_view role, std::string_view unit) {
    const TableColumn* column = table.find(role);
    const Unit* wanted = find_unit(unit);
    FIDSERVO_DEMAND(column != nullptr && wanted != nullptr);
    if (column->unit.empty() || column->unit == unit) return column->values;
    const Unit* given = find_unit(column->unit);
    if (given == nullptr || given->quantity != wanted->quantity) {
        std::vector<std::string_view> allowed;
        for (const Unit& other : units)
            if (other.quantity == wanted->quantity) allowed.push_back(other.name);
        throw InputError(fmt::format("{}: {}: unit '{}': allowed: {}", table.file.string(), role,
                                     column->unit, fmt::join(allowed, ", ")));
    }
    std::vector<double> values = column->values;
    for (double& value : values) value *= given->size / wanted->size;
    return values;
}

}  // namespace fidservo
