// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A text table (src/files/table/plain_table.h) as signals.
#include "src/files/table/table_structure.h"
#include "src/import/log.h"

#include <filesystem>

namespace fidservo::imports {

/// A signal for each column, named by its title without the unit, or by its number where it has none: "3". A
/// column of times of day is in seconds from the first row's. Empty fields are NaN. Throws InputError
/// "FILE:LINE: ..." where it is no table; what is wrong in one column alone is that signal's fault.
Log read_table_log(const std::filesystem::path& file, const TableOptions& options);

}  // namespace fidservo::imports
