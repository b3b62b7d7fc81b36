// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/files/table/table_rows.h"

#include "src/files/table/split_line.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo {

namespace {

/// A line above the rows.
struct HeaderLine {
    int line;
    bool is_comment;
    bool is_row_like;  ///< numbers in all the columns in which the rows have numbers
    bool has_number;   ///< in one of these
    bool has_text;     ///< in one of these
    bool is_all_numbers;
    std::size_t count;  ///< of its fields
    std::string text;
    std::vector<std::string> fields;  ///< none where there are more than titles can be
};

/// Titles above columns that blanks separate may hold single blanks themselves.
void split_at_wide_gaps(std::string_view line, std::vector<std::string_view>& fields) {
    fields.clear();
    line = without_blanks(line);
    while (true) {
        const std::size_t end = std::min(line.find("  "), line.find('\t'));
        fields.push_back(line.substr(0, end));
        if (end == std::string_view::npos) return;
        line = without_blanks(line.substr(end));
    }
}

HeaderLine header_line(std::string_view line, int number, char separator, const std::vector<bool>& is_key) {
    constexpr std::size_t longest_text = 1000;
    HeaderLine header{.line = number,
                      .is_comment = is_comment(line, separator),
                      .is_row_like = false,
                      .has_number = false,
                      .has_text = false,
                      .is_all_numbers = true,
                      .count = 0,
                      .text = std::string(line.substr(0, longest_text)),
                      .fields = {}};
    std::vector<std::string_view> fields;
    if (header.is_comment) line = without_comment_mark(line);
    split_line(line, separator, fields);
    if (separator == ' ' && fields.size() > is_key.size()) {
        std::vector<std::string_view> wide;
        split_at_wide_gaps(line, wide);
        if (wide.size() == is_key.size()) fields = std::move(wide);
    }
    for (std::size_t k = 0; k < fields.size(); ++k) {
        const FieldKind kind = look_at(fields[k]).kind;
        const bool is_number = kind == FieldKind::number || kind == FieldKind::time;
        header.is_all_numbers = header.is_all_numbers && kind == FieldKind::number;
        if (fields.size() != is_key.size() || !is_key[k]) continue;
        header.has_number = header.has_number || is_number;
        header.has_text = header.has_text || kind == FieldKind::text;
    }
    header.count = fields.size();
    header.is_row_like = header.has_number && !header.has_text;
    constexpr std::size_t most_surplus = 1;
    if (fields.size() <= is_key.size() + most_surplus) header.fields.assign(fields.begin(), fields.end());
    return header;
}

/// What a message adds where the user can say how many lines stand above the rows.
std::string way_out(const TableOptions& options, int header_lines) {
    return options.are_offered ? fmt::format("; if the rows begin below it: --header-lines {}", header_lines)
                               : "";
}

/// A line as LabVIEW's files have it above the rows: "Decimal_Separator" and the sign.
std::optional<DecimalSign> decimal_stated_in(const HeaderLine& header) {
    if (header.fields.size() < 2 || header.fields[0] != "Decimal_Separator") return std::nullopt;
    if (header.fields[1] == ".") return DecimalSign::point;
    if (header.fields[1] == ",") return DecimalSign::comma;
    return std::nullopt;
}

/// Fields at the end of all rows that are empty come from a separator behind the last one.
std::size_t empty_at_the_end(const TableStructure& structure) {
    const auto last = std::find_if(structure.kinds.rbegin(), structure.kinds.rend(),
                                   [](FieldKind kind) { return kind != FieldKind::empty; });
    return static_cast<std::size_t>(last - structure.kinds.rbegin());
}

bool can_be_titles(const HeaderLine& header, const TableStructure& structure) {
    const std::size_t count = header.fields.size();
    // LabVIEW names a column of comments that rows leave out.
    const bool has_comments = count == structure.fields + 1 && header.fields.back() == "Comment";
    if (!has_comments && (count > structure.fields || count < structure.fields - empty_at_the_end(structure)))
        return false;
    return count >= 2 && std::ranges::any_of(header.fields, [](const std::string& field) {
               return look_at(field).kind == FieldKind::text;
           });
}

void note_header(const std::vector<HeaderLine>& header, TableStructure& structure) {
    if (header.size() <= 1 && structure.titles.size() == header.size()) return;
    if (std::ranges::all_of(header, &HeaderLine::is_comment)) return;
    std::vector<int> lines;
    for (const TitleLine& titles : structure.titles) lines.insert(lines.begin(), titles.line);
    structure.notes.push_back(
        fmt::format("the rows begin at line {}; {}", structure.first_row.line,
                    lines.empty() ? std::string("no line above has a title for each column")
                                  : fmt::format("titles are those of line{} {}", lines.size() > 1 ? "s" : "",
                                                fmt::join(lines, " and "))));
}

/// The lowest lines that can be titles. Other lines may stand below them, and comments between them.
void take_titles(const std::vector<HeaderLine>& header, TableStructure& structure) {
    constexpr std::size_t most_lines = 8;
    for (auto line = header.rbegin(); line != header.rend() && structure.titles.size() < most_lines; ++line) {
        if (!can_be_titles(*line, structure)) {
            if (line->is_comment || structure.titles.empty()) continue;
            break;
        }
        // A number in place of a title is one of the instrument's own, unless nothing else is a title.
        if (line->has_number && !structure.titles.empty()) break;
        structure.titles.push_back({line->line, line->fields});
    }
}

std::vector<LineAbove> lowest_first(const std::vector<HeaderLine>& header, const TableStructure& structure) {
    std::vector<LineAbove> above;
    for (auto line = header.rbegin(); line != header.rend(); ++line) {
        above.push_back({.line = line->line, .text = line->text});
        if (!can_be_titles(*line, structure)) continue;
        above.back().fields = line->fields;
        above.back().has_number = line->has_number;
    }
    return above;
}

/// Lines whose last is the lowest above the rows.
class Above {
  public:
    Above(const TextFile& file, const TableOptions& options) : file_(&file), options_(&options) {}

    /// Takes the next line, which is no row unless what follows is none either.
    void add(HeaderLine line) {
        if (line.is_comment) {
            lines_.push_back(std::move(line));
        } else {
            if (row_ != 0 && !line.is_row_like) fail_on_row(line);
            if (line.is_row_like) row_ = line.line;
            other_count_ = line.is_all_numbers && !line.has_number ? line.line : 0;
            if (other_count_ != 0) other_fields_ = line.count;
            lines_.push_back(std::move(line));
        }
        constexpr std::size_t most_kept = 200;
        if (lines_.size() > most_kept) lines_.erase(lines_.begin());
    }
    /// Judges the lines when the first row is reached.
    void demand_no_row(const TableStructure& structure) const {
        if (other_count_ != 0 && !options_->header_lines)
            fail_in_line(*file_, other_count_,
                         fmt::format("has {} field{}; the rows below have {}{}", other_fields_,
                                     other_fields_ == 1 ? "" : "s", structure.fields,
                                     way_out(*options_, other_count_)));
        const auto last = std::find_if(lines_.rbegin(), lines_.rend(),
                                       [](const HeaderLine& line) { return !line.is_comment; });
        if (last == lines_.rend() || !last->has_number || options_->header_lines) return;
        const bool has_titles_above = std::any_of(last + 1, lines_.rend(), [&](const HeaderLine& line) {
            return can_be_titles(line, structure) && !line.has_number;
        });
        if (has_titles_above)
            fail_in_line(*file_, last->line,
                         fmt::format("stands between titles and rows, with text in a column of numbers{}",
                                     way_out(*options_, last->line)));
    }
    const std::vector<HeaderLine>& lines() const { return lines_; }

  private:
    [[noreturn]] void fail_on_row(const HeaderLine& text) const {
        fail_in_line(
            *file_, text.line,
            fmt::format(
                "is no row of numbers, but stands between line {}, which is one, and the rows below{}", row_,
                way_out(*options_, text.line)));
    }

    const TextFile* file_;
    const TableOptions* options_;
    std::vector<HeaderLine> lines_;
    int row_ = 0;          ///< a line that is a row of numbers
    int other_count_ = 0;  ///< the lowest line, if it is of numbers alone, but not as many as a row has
    std::size_t other_fields_ = 0;
};

}  // namespace

void find_first_row(const TextFile& file, const TableOptions& options, const std::vector<bool>& is_key,
                    LinePlace numbers, TableStructure& structure) {
    Above above(file, options);
    for (TextLines lines(file); lines.next();) {
        const int number = lines.place().line;
        if (without_blanks(lines.line()).empty()) continue;
        HeaderLine line = header_line(lines.line(), number, structure.separator, is_key);
        const bool is_below_stated = !options.header_lines || number > *options.header_lines;
        if (is_below_stated && lines.place().offset >= numbers.offset && !line.is_comment &&
            line.is_row_like) {
            structure.first_row = lines.place();
            break;
        }
        if (options.header_lines && is_below_stated && !line.is_comment)
            fail_in_line(
                file, number,
                "is no row of numbers as the rows below are, though it stands below the header's lines");
        if (!is_below_stated) line.is_row_like = false;
        if (!structure.stated_decimal) structure.stated_decimal = decimal_stated_in(line);
        above.add(std::move(line));
    }
    if (structure.first_row.offset == 0 && !above.lines().empty())
        fail_in_line(file, numbers.line,
                     "there is no row with a number in each of the columns that hold numbers");
    above.demand_no_row(structure);
    take_titles(above.lines(), structure);
    note_header(above.lines(), structure);
    if (above.lines().empty()) return;
    structure.fields_above = above.lines().back().count;
    structure.above = lowest_first(above.lines(), structure);
}

}  // namespace fidservo
