#include "src/recording/csv_text.h"

#include "core/input_error.h"

#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>

#include <fmt/format.h>

namespace fidservo {

namespace {

std::string_view trimmed(std::string_view text) {
    const auto first = text.find_first_not_of(" \t");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

void split(std::string_view line, char separator, std::vector<std::string_view>& fields) {
    fields.clear();
    if (separator == ' ') line = trimmed(line);
    while (true) {
        const auto end = line.find(separator);
        fields.push_back(trimmed(line.substr(0, end)));
        if (end == std::string_view::npos) return;
        line.remove_prefix(end + 1);
        if (separator == ' ') line = trimmed(line);
    }
}

char separator_in(std::string_view text) {
    const std::string_view first_line = text.substr(0, text.find('\n'));
    for (const char separator : {',', ';', '\t'})
        if (first_line.find(separator) != std::string_view::npos) return separator;
    return ' ';
}

template <class T>
bool parse_all(std::string_view text, T& value) {
    if (text.starts_with('+')) text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size();
}

std::string read_all(const std::filesystem::path& file) {
    std::error_code ignored;
    std::ifstream stream(file, std::ios::binary);
    if (!stream || std::filesystem::is_directory(file, ignored) ||
        std::filesystem::is_character_file(file, ignored))
        throw InputError(fmt::format("{}: cannot be opened as a text file", file.string()));
    std::string text;
    if (std::filesystem::is_regular_file(file, ignored))
        text.reserve(static_cast<std::size_t>(std::filesystem::file_size(file, ignored)));
    text.assign(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
    return text;
}

}  // namespace

CsvText CsvText::load(const std::filesystem::path& file, Separator separator) {
    return {read_all(file), file, separator};
}

std::optional<CsvText> CsvText::load_whole_lines(const std::filesystem::path& file) {
    std::string text = read_all(file);
    text.resize(text.rfind('\n') + 1);  // npos + 1 is 0
    if (text.empty()) return std::nullopt;
    return CsvText(std::move(text), file);
}

CsvText::CsvText(std::string text, std::filesystem::path file, Separator separator)
    : text_(std::move(text)),
      file_(std::move(file)),
      separator_(separator == Separator::comma ? ',' : separator_in(text_)) {
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
        if (trimmed(line).empty()) continue;
        split(line, separator_, fields_);
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
