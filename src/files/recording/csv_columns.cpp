// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/files/recording/csv_columns.h"

#include "src/files/text/key_names.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo {

namespace {

/// A title without its unit: "hall [adc]" gives "hall".
std::string_view name_of_title(std::string_view title) {
    return title.substr(0, title.find(" ["));
}

[[noreturn]] void fail_on_unknown(const CsvText& csv, std::string_view title,
                                  std::span<const ColumnTitle> known) {
    std::vector<std::string_view> titles;
    for (const ColumnTitle& column : known) titles.push_back(column.title);
    for (const std::string_view candidate : titles)
        if (name_of_title(candidate) == name_of_title(title))
            csv.fail(fmt::format("column '{}': unknown unit; it must be '{}'", title, candidate));
    if (const std::string_view meant = nearest_word(title, titles); !meant.empty())
        csv.fail(fmt::format("column '{}': unknown; did you mean '{}'?", title, meant));
    csv.fail(fmt::format("column '{}': unknown; allowed: {}", title, fmt::join(titles, ", ")));
}

}  // namespace

std::vector<std::optional<std::size_t>> find_columns(const CsvText& csv, std::span<const ColumnTitle> known) {
    std::vector<std::optional<std::size_t>> columns(known.size());
    for (std::size_t i = 0; i < csv.fields().size(); ++i) {
        std::string_view title = csv.fields()[i];
        if (i == 0 && title.starts_with('#')) title.remove_prefix(1);
        const auto found = std::find_if(known.begin(), known.end(),
                                        [&](const ColumnTitle& column) { return column.title == title; });
        if (found == known.end()) fail_on_unknown(csv, title, known);
        auto& column = columns[static_cast<std::size_t>(found - known.begin())];
        if (column) csv.fail(fmt::format("column '{}': is given twice", title));
        column = i;
    }
    for (std::size_t i = 0; i < known.size(); ++i)
        if (known[i].required && !columns[i]) csv.fail(fmt::format("column '{}' is missing", known[i].title));
    return columns;
}

}  // namespace fidservo
