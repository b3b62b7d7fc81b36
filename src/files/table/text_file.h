// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A text file from any program, line by line: its encoding, line ends and size limits.
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace fidservo {

/// The bytes of a file. Throws InputError if it cannot be opened as a text file or has more than
/// `most_bytes`.
std::string read_bytes(const std::filesystem::path& file, std::uintmax_t most_bytes = UINTMAX_MAX);

/// How many bytes UTF-8's byte order mark takes at the beginning of a text: 3, or 0 without one.
std::size_t utf8_mark_size(std::string_view bytes);

/// Text without blanks and tabs around it.
std::string_view without_blanks(std::string_view text);

inline constexpr std::uintmax_t most_table_bytes = std::uintmax_t{1} << 30U;
inline constexpr std::size_t most_line_bytes = std::size_t{1} << 20U;

/// A file that another program wrote, as UTF-8. A byte order mark is left out; it says that the file is
/// UTF-16 (either order of bytes). Bytes above 127 that are no UTF-8 count as Latin-1. A control-Z at the
/// end, as old programs write it, is left out.
class TextFile {
  public:
    /// Throws InputError: cannot be read, is empty, larger than most_table_bytes, holds control characters (a
    /// binary file), UTF-16 that breaks off.
    static TextFile load(const std::filesystem::path& file);
    /// The same from bytes; `file` only appears in messages.
    static TextFile parse(std::string bytes, const std::filesystem::path& file);

    const std::string& text() const { return text_; }
    const std::filesystem::path& file() const { return file_; }
    /// Whether the last line is terminated.
    bool ends_with_line_end() const;

  private:
    TextFile(std::string text, std::filesystem::path file) : text_(std::move(text)), file_(std::move(file)) {}
    std::string text_;
    std::filesystem::path file_;
};

/// Where a line begins.
struct LinePlace {
    std::size_t offset = 0;
    int line = 1;
};

/// The lines of a text file from a place on, without their ends: LF, CR LF or CR alone.
class TextLines {
  public:
    explicit TextLines(const TextFile& file, LinePlace from = {});

    /// Throws InputError on a line of more than most_line_bytes.
    bool next();
    std::string_view line() const { return line_; }
    /// Where the line begins that next() returned.
    const LinePlace& place() const { return place_; }

  private:
    const TextFile* file_;
    LinePlace place_;
    LinePlace next_;
    const char* ends_;  ///< the characters that can end a line in this file
    std::string_view line_;
};

}  // namespace fidservo
