// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Finds where the rows of a table begin, and the titles above them.
#include "src/files/table/table_structure.h"

namespace fidservo {

/// Finds the first row, and the titles above it, for a structure whose separator, fields and kinds are known.
/// @param is_key  the columns in which every row has a number
/// @param numbers  where the block of lines at the end begins that have this number of fields and a number
/// each
/// @throws InputError where it could be another line
void find_first_row(const TextFile& file, const TableOptions& options, const std::vector<bool>& is_key,
                    LinePlace numbers, TableStructure& structure);

}  // namespace fidservo
