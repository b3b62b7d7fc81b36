// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/files/table/split_line.h"

#include "src/files/table/text_file.h"

#include <algorithm>

namespace fidservo {

namespace {

bool is_between(std::string_view field, char quote) {
    return field.size() >= 2 && field.front() == quote && field.back() == quote;
}

std::string_view without_quotes(std::string_view field) {
    field = without_blanks(field);
    if (is_between(field, '"') || is_between(field, '\''))
        return without_blanks(field.substr(1, field.size() - 2));
    return field;
}

/// Where the field ends that a line begins with.
std::size_t end_of_field(std::string_view line, std::string_view separators) {
    std::size_t from = line.find_first_not_of(" \t");
    if (from != std::string_view::npos && line[from] == '"') {
        do {
            from = line.find('"', from + 1);
            if (from == std::string_view::npos) return from;
            ++from;
        } while (from < line.size() && line[from] == '"');  // two in turn stand for one
    } else {
        from = 0;
    }
    return line.find_first_of(separators, from);
}

}  // namespace

void split_line(std::string_view line, char separator, std::vector<std::string_view>& fields) {
    fields.clear();
    const bool by_blanks = separator == ' ';
    const std::string_view separators = by_blanks ? std::string_view(" \t") : std::string_view(&separator, 1);
    if (by_blanks) line = without_blanks(line);
    while (true) {
        const std::size_t end = end_of_field(line, separators);
        fields.push_back(without_quotes(line.substr(0, end)));
        if (end == std::string_view::npos) return;
        line.remove_prefix(end + 1);
        if (by_blanks) line = without_blanks(line);
    }
}

bool is_comment(std::string_view line, char separator) {
    line = without_blanks(line);
    // What spreadsheets write for a cell that has no value.
    for (const std::string_view error : {"#N/A", "#VALUE", "#REF", "#DIV", "#NUM", "#NAME", "#NULL"})
        if (line.starts_with(error)) return false;
    return line.starts_with('#') || line.starts_with('%') || line.starts_with("//") ||
           line.starts_with('!') || (line.starts_with(';') && separator != ';');
}

std::string_view without_comment_mark(std::string_view line) {
    line = without_blanks(line);
    return without_blanks(line.substr(std::min(line.find_first_not_of("#%/!;"), line.size())));
}

}  // namespace fidservo
