// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A table of numbers from another program: with or without titles, possibly below a header by the instrument,
// numbers with decimal points or commas.
#include "src/files/table/table_structure.h"

#include <functional>
#include <span>

namespace fidservo {

struct TableRow {
    int line;
    std::span<const std::string_view> fields;
};

struct DecimalEvidence;

class PlainTable {
  public:
    /// Throws InputError on a file that structure_of() refuses, on rows of another length, on numbers of
    /// which some have a decimal point and others a decimal comma, and where commas could be separators or
    /// decimal signs.
    static PlainTable load(const std::filesystem::path& file, const TableOptions& options = {});
    static PlainTable parse(TextFile file, const TableOptions& options = {});

    /// How many columns there are, empty ones at the end left out.
    std::size_t columns() const;
    FieldKind kind(std::size_t column) const { return structure_.kinds[column]; }
    const std::vector<TitleLine>& titles() const { return structure_.titles; }
    /// Titles and all other lines above the rows, the lowest first.
    const std::vector<LineAbove>& above() const { return structure_.above; }
    int first_line() const { return structure_.first_row.line; }
    int last_line() const { return structure_.last_line; }
    /// Whether the last row's line is terminated.
    bool last_row_ends() const { return structure_.end < file_.text().size(); }
    const std::filesystem::path& file() const { return file_.file(); }

    /// Notes for the user: what was skipped, and what was decided.
    const std::vector<std::string>& notes() const { return structure_.notes; }

    void for_each_row(const std::function<void(const TableRow&)>& visit) const;

    /// A row's field as a number. Throws InputError if it is none or not finite, and where the whole table
    /// does not tell whether it is 1.234 or 1234.
    double number(const TableRow& row, std::size_t column) const;

    [[noreturn]] void fail(const TableRow& row, std::size_t column, std::string_view message) const;
    [[noreturn]] void fail(int line, std::string_view message) const { fail_in_line(file_, line, message); }

  private:
    PlainTable(TextFile file, TableStructure structure, bool options_are_offered)
        : file_(std::move(file)),
          structure_(std::move(structure)),
          options_are_offered_(options_are_offered) {}

    void decide_decimal_sign(const TableOptions& options);
    /// Throws InputError if fields between commas could be parts of one number.
    void demand_whole_numbers(const DecimalEvidence& evidence, std::string_view no_such_table) const;

    TextFile file_;
    TableStructure structure_;
    bool options_are_offered_;
    std::optional<DecimalSign> decimal_;  ///< empty: no number of the table shows it
};

}  // namespace fidservo
