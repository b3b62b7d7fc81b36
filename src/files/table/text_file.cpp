// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/files/table/text_file.h"

#include "core/input_error.h"

#include <algorithm>
#include <array>
#include <fstream>

#include <fmt/format.h>

namespace fidservo {

namespace {

constexpr std::string_view utf8_mark = "\xEF\xBB\xBF";
constexpr std::string_view utf16_low_first = "\xFF\xFE";
constexpr std::string_view utf16_high_first = "\xFE\xFF";

void append_utf8(std::string& text, std::uint32_t character) {
    const auto add = [&](std::uint32_t byte) { text.push_back(static_cast<char>(byte)); };
    if (character < 0x80) {
        add(character);
    } else if (character < 0x800) {
        add(0xC0 | character >> 6U);
        add(0x80 | (character & 0x3FU));
    } else if (character < 0x10000) {
        add(0xE0 | character >> 12U);
        add(0x80 | (character >> 6U & 0x3FU));
        add(0x80 | (character & 0x3FU));
    } else {
        add(0xF0 | character >> 18U);
        add(0x80 | (character >> 12U & 0x3FU));
        add(0x80 | (character >> 6U & 0x3FU));
        add(0x80 | (character & 0x3FU));
    }
}

std::string from_utf16(std::string_view bytes, bool low_first, const std::filesystem::path& file) {
    const auto fail = [&] {
        throw InputError(fmt::format(
            "{}: begins as UTF-16 does, and breaks off or holds what is no character", file.string()));
    };
    if (bytes.size() % 2 != 0) fail();
    const auto unit = [&](std::size_t k) {
        const auto first = static_cast<unsigned char>(bytes[k]),
                   second = static_cast<unsigned char>(bytes[k + 1]);
        return static_cast<std::uint32_t>(low_first ? first | second << 8U : first << 8U | second);
    };
    const auto leads = [](std::uint32_t value) { return value >= 0xD800 && value < 0xDC00; };
    const auto trails = [](std::uint32_t value) { return value >= 0xDC00 && value < 0xE000; };
    std::string text;
    text.reserve(bytes.size() / 2);
    for (std::size_t k = 0; k < bytes.size(); k += 2) {
        std::uint32_t character = unit(k);
        if (trails(character)) fail();
        if (leads(character)) {
            k += 2;
            if (k >= bytes.size() || !trails(unit(k))) fail();
            character = 0x10000 + ((character - 0xD800) << 10U) + (unit(k) - 0xDC00);
        }
        append_utf8(text, character);
    }
    return text;
}

/// How many bytes the UTF-8 character has whose first byte is above 127; 0 if it is none.
std::size_t long_character_at(std::string_view text) {
    const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
    const std::size_t length = byte(0) >= 0xC2 && byte(0) < 0xE0   ? 2
                               : byte(0) >= 0xE0 && byte(0) < 0xF0 ? 3
                               : byte(0) >= 0xF0 && byte(0) < 0xF5 ? 4
                                                                   : 0;
    if (length == 0 || text.size() < length) return 0;
    for (std::size_t k = 1; k < length; ++k)
        if ((byte(k) & 0xC0U) != 0x80) return 0;
    return length;
}

/// Latin-1 where a text is not UTF-8.
std::string as_utf8(std::string text) {
    const auto is_long = [](char letter) { return static_cast<unsigned char>(letter) > 127; };
    bool is_utf8 = true;
    for (auto at = std::ranges::find_if(text, is_long); is_utf8 && at != text.end();) {
        const std::size_t length = long_character_at({&*at, static_cast<std::size_t>(text.end() - at)});
        is_utf8 = length > 0;
        at = std::find_if(at + static_cast<std::ptrdiff_t>(length), text.end(), is_long);
    }
    if (is_utf8) return text;
    std::string converted;
    converted.reserve(text.size() + text.size() / 8);
    for (const char letter : text) append_utf8(converted, static_cast<unsigned char>(letter));
    return converted;
}

void demand_no_control_characters(std::string_view text, const std::filesystem::path& file) {
    const auto is_control = [](unsigned char letter) {
        return (letter < ' ' && letter != '\t' && letter != '\n' && letter != '\r') || letter == 127;
    };
    const auto found = std::ranges::find_if(text, is_control);
    if (found == text.end()) return;
    throw InputError(fmt::format(
        "{}: byte {} is {:#04x}: no text; allowed: text in UTF-8, Latin-1, or UTF-16 with a byte order mark",
        file.string(), found - text.begin() + 1, static_cast<unsigned char>(*found)));
}

}  // namespace

std::string read_bytes(const std::filesystem::path& file, std::uintmax_t most_bytes) {
    std::error_code ignored;
    std::ifstream stream(file, std::ios::binary);
    if (!stream || std::filesystem::is_directory(file, ignored) ||
        std::filesystem::is_character_file(file, ignored))
        throw InputError(fmt::format("{}: cannot be opened as a text file", file.string()));
    const auto demand_size = [&](std::uintmax_t bytes) {
        if (bytes > most_bytes)
            throw InputError(
                fmt::format("{}: has more than {} bytes, the most that is read", file.string(), most_bytes));
    };
    std::string bytes;
    if (std::filesystem::is_regular_file(file, ignored)) {
        const std::uintmax_t size = std::filesystem::file_size(file, ignored);
        demand_size(size);
        bytes.reserve(static_cast<std::size_t>(size));
    }
    std::array<char, 1U << 16U> block;
    do {
        stream.read(block.data(), static_cast<std::streamsize>(block.size()));
        bytes.append(block.data(), static_cast<std::size_t>(stream.gcount()));
        demand_size(bytes.size());
    } while (stream);
    return bytes;
}

std::size_t utf8_mark_size(std::string_view bytes) {
    return bytes.starts_with(utf8_mark) ? utf8_mark.size() : 0;
}

std::string_view without_blanks(std::string_view text) {
    const auto first = text.find_first_not_of(" \t");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

TextFile TextFile::load(const std::filesystem::path& file) {
    return parse(read_bytes(file, most_table_bytes), file);
}

TextFile TextFile::parse(std::string bytes, const std::filesystem::path& file) {
    const bool low_first = bytes.starts_with(utf16_low_first);
    std::string text;
    if (low_first || bytes.starts_with(utf16_high_first)) {
        text = from_utf16(std::string_view(bytes).substr(2), low_first, file);
    } else {
        bytes.erase(0, utf8_mark_size(bytes));
        text = as_utf8(std::move(bytes));
    }
    constexpr char control_z = '\x1A';
    while (text.ends_with(control_z)) text.pop_back();
    if (text.empty()) throw InputError(fmt::format("{}: is empty", file.string()));
    demand_no_control_characters(text, file);
    return {std::move(text), file};
}

bool TextFile::ends_with_line_end() const {
    return text_.ends_with('\n') || text_.ends_with('\r');
}

TextLines::TextLines(const TextFile& file, LinePlace from)
    : file_(&file), next_(from), ends_(file.text().find('\r') == std::string::npos ? "\n" : "\r\n") {}

bool TextLines::next() {
    const std::string_view text = file_->text();
    if (next_.offset >= text.size()) return false;
    place_ = next_;
    const std::size_t end = std::min(text.find_first_of(ends_, place_.offset), text.size());
    line_ = text.substr(place_.offset, end - place_.offset);
    if (line_.size() > most_line_bytes)
        throw InputError(fmt::format("{}:{}: the line has {} bytes; allowed: {} at most",
                                     file_->file().string(), place_.line, line_.size(), most_line_bytes));
    next_ = {text.substr(end).starts_with("\r\n") ? end + 2 : end + 1, place_.line + 1};
    return true;
}

}  // namespace fidservo
