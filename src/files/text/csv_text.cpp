// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/files/text/csv_text.h"

#include "core/input_error.h"
#include "src/files/table/text_file.h"
#include "src/files/text/plain_number.h"

#include <cmath>

#include <fmt/format.h>

namespace fidservo {

namespace {

void split_at_commas(std::string_view line, std::vector<std::string_view>& fields) {
    fields.clear();
    while (true) {
        const auto end = line.find(',');
        fields.push_back(without_blanks(line.substr(0, end)));
        if (end == std::string_view::npos) return;
        line.remove_prefix(end + 1);
    }
}

/// The bytes of a file without UTF-8's byte order mark.
std::string read_all(const std::filesystem::path& file) {
    std::string text = read_bytes(file);
    text.erase(0, utf8_mark_size(text));
    return text;
}

}  // namespace

CsvText CsvText::load(const std::filesystem::path& file) {
    return {read_all(file), file};
}

std::optional<CsvText> CsvText::load_whole_lines(const std::filesystem::path& file) {
    std::string text = read_all(file);
    text.resize(text.rfind('\n') + 1);  // npos + 1 is 0
    if (text.empty()) return std::nullopt;
    return CsvText(std::move(text), file);
}

CsvText::CsvText(std::string text, std::filesystem::path file)
    : text_(std::move(text)), file_(std::move(file)) {
    if (text_.empty()) throw InputError(fmt::format("{}: is empty", file_.string()));
}

bool CsvText::next() {
    while (position_ < text_.size()) {
        ++line_;
        const std::size_t end = text_.find('\n', position_);
        if (end == std::string::npos) fail("the last line does not end: the file was cut off");
        std::string_view line(text_.data() + position_, end - position_);
        position_ = end + 1;
        if (line.ends_with('\r')) line.remove_suffix(1);
        if (without_blanks(line).empty()) continue;
        split_at_commas(line, fields_);
        return true;
    }
    return false;
}

double CsvText::number(std::size_t i) const {
    double value = 0.0;
    if (!parse_all(fields_[i], value))
        fail(fmt::format("column {}: '{}': must be a number", i + 1, fields_[i]));
    if (!std::isfinite(value)) fail(fmt::format("column {}: '{}': must be finite", i + 1, fields_[i]));
    return value;
}

std::int64_t CsvText::integer(std::size_t i) const {
    std::int64_t value = 0;
    if (!parse_all(fields_[i], value))
        fail(fmt::format("column {}: '{}': must be a whole number", i + 1, fields_[i]));
    return value;
}

void CsvText::expect_fields(std::size_t count) const {
    if (fields_.size() != count)
        fail(fmt::format("has {} fields; the header names {}", fields_.size(), count));
}

void CsvText::fail(std::string_view message) const {
    throw InputError(fmt::format("{}:{}: {}", file_.string(), line_, message));
}

}  // namespace fidservo
