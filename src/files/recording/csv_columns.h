// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The header of a recording's CSV file: which quantity each column holds.
#include "src/files/text/csv_text.h"

#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace fidservo {

/// A column that a file may have. `title` is its name and unit as in the header, e.g. "hall [adc]".
struct ColumnTitle {
    std::string_view title;
    bool required;
};

/// For each known title the column's index in this file, read from the present line of `csv`, the header.
/// Throws InputError on a column that is unknown, given twice, missing, or in another unit.
std::vector<std::optional<std::size_t>> find_columns(const CsvText& csv, std::span<const ColumnTitle> known);

}  // namespace fidservo
