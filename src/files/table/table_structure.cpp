// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/files/table/table_structure.h"

#include "core/input_error.h"
#include "src/files/table/split_line.h"
#include "src/files/table/table_rows.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <deque>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo {

namespace {

bool is_blank(std::string_view line) {
    return without_blanks(line).empty();
}

/// The first and the last lines of a file that are not blank, as many as tell what it is made of.
std::vector<std::string_view> sample_of(const TextFile& file, LinePlace from) {
    constexpr std::size_t at_each_end = 1000;
    std::vector<std::string_view> sample;
    std::deque<std::string_view> last;
    for (TextLines lines(file, from); lines.next();) {
        if (is_blank(lines.line())) continue;
        if (sample.size() < at_each_end) {
            sample.push_back(lines.line());
            continue;
        }
        last.push_back(lines.line());
        if (last.size() > at_each_end) last.pop_front();
    }
    sample.insert(sample.end(), last.begin(), last.end());
    return sample;
}

struct Candidate {
    char separator = 0;
    std::size_t fields = 0;
    double weight = 0.0;  ///< rows, each by the share of its fields that are numbers
};

Candidate candidate_with(char separator, const std::vector<std::string_view>& sample) {
    std::map<std::size_t, double> weights;
    std::vector<std::string_view> fields;
    for (const std::string_view line : sample) {
        if (is_comment(line, separator)) continue;
        split_line(line, separator, fields);
        if (fields.size() < 2 || fields.size() > most_table_columns) continue;
        std::size_t texts = 0, numbers = 0;
        for (const std::string_view field : fields) {
            const FieldKind kind = look_at(field).kind;
            texts += kind == FieldKind::text;
            numbers += kind == FieldKind::number || kind == FieldKind::time;
        }
        if (numbers > 0)
            weights[fields.size()] += 1.0 - static_cast<double>(texts) / static_cast<double>(fields.size());
    }
    Candidate best{.separator = separator};
    for (const auto& [count, weight] : weights)
        if (weight > best.weight) best = {separator, count, weight};
    return best;
}

/// A first line "sep=;", as spreadsheets write and read it.
std::optional<char> stated_separator(const TextFile& file) {
    constexpr std::string_view key = "sep=";
    TextLines lines(file);
    if (!lines.next() || !lines.line().starts_with(key) || lines.line().size() != key.size() + 1)
        return std::nullopt;
    return lines.line().back();
}

Candidate choose_separator(const TextFile& file, LinePlace from, const TableOptions& options) {
    constexpr std::array all{'\t', ';', '|', ',', ' '};
    const auto stated = options.separator ? options.separator : stated_separator(file);
    const std::vector<std::string_view> sample = sample_of(file, from);
    Candidate best;
    for (const char separator : all) {
        if (stated && *stated != separator) continue;
        const Candidate candidate = candidate_with(separator, sample);
        if (candidate.weight > best.weight) best = candidate;
    }
    if (best.fields > 0) return best;
    if (sample.empty()) fail_in_line(file, from.line, "there is no row");
    for (const std::string_view line : sample)
        if (std::ranges::count(line, ',') >= static_cast<std::ptrdiff_t>(most_table_columns))
            fail_in_line(
                file, from.line,
                fmt::format("a line has more than {} fields, the most that are read", most_table_columns));
    fail_in_line(
        file, from.line,
        fmt::format(
            "there is no row of two or more fields with a number among them; allowed between fields: {}",
            stated ? separator_name(*stated) : "tabs, semicolons, |, commas or blanks"));
}

LinePlace behind_lines(const TextFile& file, int count) {
    TextLines lines(file);
    for (int k = 0; k < count; ++k)
        if (!lines.next())
            throw InputError(
                fmt::format("{}: --header-lines: {}: the file has {} lines", file.file().string(), count, k));
    if (!lines.next())
        throw InputError(
            fmt::format("{}: --header-lines: {}: there is no line below", file.file().string(), count));
    return lines.place();
}

/// How often each kind of field was met in a column.
struct KindCounts {
    std::array<std::size_t, 4> of{};
    std::size_t operator[](FieldKind kind) const { return of[static_cast<std::size_t>(kind)]; }

    FieldKind most() const {
        FieldKind kind = FieldKind::number;
        for (const FieldKind other : {FieldKind::time, FieldKind::text})
            if ((*this)[other] > (*this)[kind]) kind = other;
        return (*this)[kind] > 0 ? kind : FieldKind::empty;
    }
    bool is_filled() const {
        return 2 * (*this)[FieldKind::empty] <= of[0] + of[1] + of[2] + of[3] - (*this)[FieldKind::empty];
    }
};

/// Lines in turn with as many fields and a number each.
struct LinesWithNumbers {
    LinePlace begin;
    std::size_t end = 0;
    int last_line = 0;
    std::size_t lines = 0;
    std::vector<KindCounts> columns;
};

struct Below {
    std::size_t lines = 0;
    int first_line = 0;
    std::string first;
    int row_sized = 0;  ///< the first line with a field for each column, none of them empty

    void add(int line, std::string_view text, bool is_row_sized) {
        if (is_row_sized && row_sized == 0) row_sized = line;
        if (lines++ == 0) {
            first_line = line;
            first = excerpt(text);
        }
    }
};

/// The last such lines of the file, and what stands below them.
std::pair<LinesWithNumbers, Below> last_numbers(const TextFile& file, LinePlace from,
                                                const Candidate& shape) {
    LinesWithNumbers run;
    Below below;
    bool is_open = false;
    std::vector<std::string_view> fields;
    std::vector<FieldKind> kinds;
    for (TextLines lines(file, from); lines.next();) {
        const std::string_view line = lines.line();
        if (is_blank(line) || is_comment(line, shape.separator)) continue;
        split_line(line, shape.separator, fields);
        kinds.clear();
        for (const std::string_view field : fields) kinds.push_back(look_at(field).kind);
        const bool any_number = std::ranges::any_of(
            kinds, [](FieldKind kind) { return kind == FieldKind::number || kind == FieldKind::time; });
        const bool only_empty =
            std::ranges::all_of(kinds, [](FieldKind kind) { return kind == FieldKind::empty; });
        if (fields.size() != shape.fields || !any_number) {
            if (only_empty && fields.size() == shape.fields && is_open) {
                below.add(lines.place().line, line, false);
                continue;
            }
            is_open = false;
            if (run.lines > 0 && kinds.front() == FieldKind::number && fields.size() != shape.fields)
                fail_in_line(
                    file, lines.place().line,
                    fmt::format("has {} fields; the rows above have {}", fields.size(), shape.fields));
            below.add(
                lines.place().line, line,
                fields.size() == shape.fields && std::ranges::find(kinds, FieldKind::empty) == kinds.end());
            continue;
        }
        if (!is_open) run = {lines.place(), 0, 0, 0, std::vector<KindCounts>(shape.fields)};
        is_open = true;
        below = {};
        ++run.lines;
        run.end = lines.place().offset + line.size();
        run.last_line = lines.place().line;
        for (std::size_t k = 0; k < kinds.size(); ++k)
            ++run.columns[k].of[static_cast<std::size_t>(kinds[k])];
    }
    return {std::move(run), std::move(below)};
}

}  // namespace

std::string_view separator_name(char separator) {
    switch (separator) {
        case '\t':
            return "tabs";
        case ';':
            return "semicolons";
        case ',':
            return "commas";
        case '|':
            return "|";
        default:
            return "blanks";
    }
}

std::string excerpt(std::string_view text) {
    constexpr std::size_t longest = 60;
    std::string piece(without_blanks(text).substr(0, longest));
    // No half of a character at the end.
    while (text.size() > longest && !piece.empty() && (static_cast<unsigned char>(piece.back()) & 0x80U) != 0)
        piece.pop_back();
    std::ranges::replace(piece, '\t', ' ');
    return without_blanks(text).size() > longest ? piece + "..." : piece;
}

void fail_in_line(const TextFile& file, int line, std::string_view message) {
    throw InputError(fmt::format("{}:{}: {}", file.file().string(), line, message));
}

TableStructure structure_of(const TextFile& file, const TableOptions& options) {
    const LinePlace from = options.header_lines ? behind_lines(file, *options.header_lines) : LinePlace{};
    const Candidate shape = choose_separator(file, from, options);
    auto [run, below] = last_numbers(file, from, shape);
    if (run.lines == 0) fail_in_line(file, from.line, "there is no row of numbers");
    TableStructure structure{.separator = shape.separator,
                             .fields = shape.fields,
                             .end = run.end,
                             .last_line = run.last_line,
                             .stated_decimal = options.decimal};
    std::vector<bool> is_key;  // columns in which every row has a number
    for (const KindCounts& counts : run.columns) {
        structure.kinds.push_back(counts.most());
        const bool is_number = counts.most() == FieldKind::number || counts.most() == FieldKind::time;
        is_key.push_back(is_number && counts.is_filled());
    }
    if (std::ranges::none_of(is_key, [](bool key) { return key; }))
        for (std::size_t k = 0; k < is_key.size(); ++k)
            is_key[k] = structure.kinds[k] == FieldKind::number || structure.kinds[k] == FieldKind::time;
    if (below.row_sized != 0)
        fail_in_line(
            file, below.row_sized,
            "has a field for each column, but no number: below the rows only other lines of text may stand");
    find_first_row(file, options, is_key, run.begin, structure);
    if (below.lines > 0)
        structure.notes.push_back(
            fmt::format("{} lines below the rows are passed over, from line {} on: '{}'", below.lines,
                        below.first_line, below.first));
    return structure;
}

}  // namespace fidservo
