// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A CSV file as this program writes them, in memory, read line by line and field by field without copies:
// fields between commas, lines that end in LF or CR LF; UTF-8's byte order mark may stand in front. Errors
// are InputError "FILE:LINE: message". Tables of other programs: src/files/table/plain_table.h.
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fidservo {

class CsvText {
  public:
    /// Reads the whole file. Throws InputError if it cannot be read or is empty.
    static CsvText load(const std::filesystem::path& file);
    /// The whole lines of a file with commas whose writer was ended in the middle; empty if there is none.
    /// Throws InputError if it cannot be read.
    static std::optional<CsvText> load_whole_lines(const std::filesystem::path& file);
    /// The same from text; `file` only appears in messages.
    CsvText(std::string text, std::filesystem::path file);

    /// The next line without its end, split into fields; false at the end of the file. A last line that does
    /// not end is an error: the file was cut off. Blank lines are passed over.
    bool next();
    int line() const { return line_; }
    const std::vector<std::string_view>& fields() const { return fields_; }

    /// Field i as a number: an error if it is empty, not a number, not finite.
    double number(std::size_t i) const;
    std::int64_t integer(std::size_t i) const;
    /// Demands a number of fields on this line.
    void expect_fields(std::size_t count) const;

    [[noreturn]] void fail(std::string_view message) const;
    const std::filesystem::path& file() const { return file_; }

  private:
    std::string text_;
    std::filesystem::path file_;
    std::size_t position_ = 0;
    int line_ = 0;
    std::vector<std::string_view> fields_;
};

}  // namespace fidservo
