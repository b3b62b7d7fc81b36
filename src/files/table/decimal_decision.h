// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Decides from all numbers of a table whether point or comma is its decimal sign.
#include "src/files/table/plain_table.h"

namespace fidservo {

/// What the numbers of a table show; for each kind the first line.
struct DecimalEvidence {
    struct Place {
        int line = 0;
        std::string field = {};
    };
    Place point = {}, comma = {};
    bool has_point_between_commas =
        false;  ///< 1.234 between commas: no program writes points between thousands there
    /// In a table separated by commas, a column that could be the decimals of the one before it: digits
    /// alone, all as many; or a zero in front of other digits, several digits before an exponent, and in the
    /// one before it a zero with a sign.
    std::optional<std::size_t> could_be_decimals = {};
    /// In a table separated by commas, a column that could be the last three digits of the one before it, or
    /// more digits if these are followed by a point.
    std::optional<std::size_t> could_be_thousands = {};
};

/// Looks at all rows. @param columns  of the table
DecimalEvidence decimal_evidence_of(const PlainTable& table, char separator, std::size_t columns);

}  // namespace fidservo
