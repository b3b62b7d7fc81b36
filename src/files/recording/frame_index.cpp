// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/files/recording/frame_index.h"

#include "core/input_error.h"
#include "src/files/recording/index_time.h"
#include "src/files/table/plain_table.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace fidservo {

namespace {

namespace fs = std::filesystem;

constexpr TableOptions index_options{.are_offered = false};

bool has_image_ending(std::string_view name) {
    constexpr std::array<std::string_view, 10> endings{".png",  ".jpg", ".jpeg", ".bmp",  ".tif",
                                                       ".tiff", ".pgm", ".ppm",  ".webp", ".pnm"};
    const auto dot = name.rfind('.');
    if (dot == std::string_view::npos) return false;
    std::string ending(name.substr(dot));
    std::ranges::transform(ending, ending.begin(), [](unsigned char a) { return std::tolower(a); });
    return std::ranges::find(endings, ending) != endings.end();
}

/// Columns whose title in any line has one of the words.
std::vector<std::size_t> columns_with_word(const PlainTable& table,
                                           std::initializer_list<std::string_view> words) {
    std::vector<std::size_t> found;
    for (std::size_t k = 0; k < table.columns(); ++k)
        for (const TitleLine& titles : table.titles()) {
            if (k >= titles.fields.size()) continue;
            std::string title = titles.fields[k];
            std::ranges::transform(title, title.begin(), [](unsigned char a) { return std::tolower(a); });
            if (std::ranges::any_of(
                    words, [&](std::string_view word) { return title.find(word) != std::string::npos; })) {
                found.push_back(k);
                break;
            }
        }
    return found;
}

struct IndexColumns {
    std::size_t time, name;
};

/// The columns by their fields: names are text that ends as images do, times are numbers. Titles decide
/// between several of one kind.
IndexColumns index_columns(const PlainTable& table) {
    std::vector<std::size_t> times, names;
    std::vector<std::size_t> named(table.columns(), 0);
    std::size_t rows = 0;
    table.for_each_row([&](const TableRow& row) {
        ++rows;
        for (std::size_t k = 0; k < table.columns(); ++k) named[k] += has_image_ending(row.fields[k]);
    });
    for (std::size_t k = 0; k < table.columns(); ++k) {
        if (table.kind(k) == FieldKind::number) times.push_back(k);
        if (table.kind(k) == FieldKind::text && named[k] == rows) names.push_back(k);
    }
    const auto narrowed = [&](std::vector<std::size_t> columns,
                              std::initializer_list<std::string_view> words) {
        if (columns.size() < 2) return columns;
        std::vector<std::size_t> both;
        std::ranges::set_intersection(columns, columns_with_word(table, words), std::back_inserter(both));
        return both;
    };
    if (names.empty())
        for (std::size_t k = 0; k < table.columns(); ++k)
            if (table.kind(k) == FieldKind::text) names.push_back(k);
    names = narrowed(names, {"filename", "file name", "file", "image", "rgb"});
    times = narrowed(times, {"timestamp", "time stamp", "time"});
    if (times.size() != 1)
        table.fail(
            table.first_line(),
            "which column holds the times? allowed: one column of numbers, or one whose title is timestamp");
    if (names.size() != 1)
        table.fail(table.first_line(),
                   "which column holds the images' names? allowed: one column of text, or one whose title is "
                   "filename");
    for (const TitleLine& titles : table.titles())
        for (const std::string& field : titles.fields)
            if (has_image_ending(field))
                table.fail(titles.line,
                           fmt::format("'{}' names an image, but the line has no time", excerpt(field)));
    return {times.front(), names.front()};
}

/// Finds the files of an index.
class FrameFiles {
  public:
    explicit FrameFiles(const fs::path& index) : folder_(index.parent_path()), data_(folder_ / "data") {}

    /// What a name becomes; whether a file is there.
    std::pair<std::string, bool> find(std::string_view written) {
        std::string name(written);
        if (is_file(data_ / name) && fs::path(name).is_relative()) return {name, true};
        std::ranges::replace(name, '\\', '/');
        const fs::path path(name);
        if (path.has_parent_path()) {
            if (path.is_relative() && is_file(folder_ / path)) return from_index(path);
            const std::string last = path.filename().string();
            if (!last.empty() && is_file(data_ / last)) return by_last_part(written, last, last);
            if (!last.empty() && is_file(folder_ / last))
                return by_last_part(written, last, absolute(folder_ / last));
        } else if (is_file(folder_ / path)) {
            return {absolute(folder_ / path), true};
        }
        return {std::string(written), false};
    }
    int by_last_part_alone() const { return by_last_part_; }
    const std::string& first_by_last_part() const { return first_; }

  private:
    static bool is_file(const fs::path& path) {
        std::error_code ignored;
        return fs::is_regular_file(path, ignored);
    }
    static std::string absolute(const fs::path& path) {
        return fs::absolute(path).lexically_normal().string();
    }
    /// "data/x.png", which the recordings' own form calls x.png, or a file elsewhere.
    std::pair<std::string, bool> from_index(const fs::path& path) const {
        const fs::path in_data = path.lexically_normal().lexically_relative("data");
        const bool is_in_data = !in_data.empty() && *in_data.begin() != "..";
        return {is_in_data ? in_data.string() : absolute(folder_ / path), true};
    }
    std::pair<std::string, bool> by_last_part(std::string_view written, const std::string& last,
                                              std::string found) {
        if (by_last_part_++ == 0) first_ = fmt::format("'{}' as {}", excerpt(written), last);
        return {std::move(found), true};
    }

    fs::path folder_, data_;
    int by_last_part_ = 0;
    std::string first_;
};

std::string unit_in_titles(const PlainTable& table, std::size_t column) {
    for (const TitleLine& titles : table.titles())
        if (column < titles.fields.size())
            if (std::string unit = index_unit_of(titles.fields[column]); !unit.empty()) return unit;
    return "";
}

/// Times rise by at least one unit, and not by 1 ns throughout.
void demand_times(const PlainTable& table, const std::vector<FrameName>& frames,
                  const std::vector<int>& lines) {
    bool all_by_one = frames.size() > 1;
    for (std::size_t k = 1; k < frames.size(); ++k) {
        if (frames[k].time_ns <= frames[k - 1].time_ns)
            table.fail(lines[k], fmt::format("timestamp: {} ns: must be after that of the row before, {} ns",
                                             frames[k].time_ns, frames[k - 1].time_ns));
        all_by_one = all_by_one && frames[k].time_ns - frames[k - 1].time_ns == 1;
    }
    if (all_by_one)
        table.fail(lines.front(),
                   "times rise by 1 ns from image to image, as numbers of frames do: no times");
}

}  // namespace

std::vector<FrameName> read_frame_index(const fs::path& file) {
    const PlainTable table = PlainTable::load(file, index_options);
    const IndexColumns columns = index_columns(table);
    const std::string unit = unit_in_titles(table, columns.time);
    FrameFiles files(file);
    std::vector<FrameName> frames;
    std::vector<int> lines;
    std::map<std::string, int> line_of_name;
    table.for_each_row([&](const TableRow& row) {
        const std::string_view name = row.fields[columns.name];
        if (name.empty()) table.fail(row, columns.name, "must be the name of an image");
        const auto time = index_time_ns(row.fields[columns.time], unit);
        if (!time) table.fail(row, columns.time, time.error());
        auto [found, is_there] = files.find(name);
        if (row.line == table.last_line() && !table.last_row_ends() && !is_there)
            table.fail(row, columns.name,
                       "the last line does not end, and there is no such file: the list was cut off");
        const auto [earlier, is_new] = line_of_name.emplace(found, row.line);
        if (!is_new)
            table.fail(row, columns.name, fmt::format("is named in line {} already", earlier->second));
        frames.push_back({*time, std::move(found)});
        lines.push_back(row.line);
    });
    demand_times(table, frames, lines);
    for (const std::string& note : table.notes()) spdlog::warn("{}: {}", file.string(), note);
    if (files.by_last_part_alone() > 0)
        spdlog::warn("{}: {} of {} images are found by the last part of their path alone: {}", file.string(),
                     files.by_last_part_alone(), frames.size(), files.first_by_last_part());
    return frames;
}

}  // namespace fidservo
