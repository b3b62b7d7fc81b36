// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A text table (src/files/table/plain_table.h) as signals.
#include "src/files/table/table_structure.h"
#include "src/import/log.h"

#include <filesystem>

namespace fidservo::imports {

/// A signal for each column, named by the column's title without its unit, or by the column's number, such as
/// "3", if it has no title. Times of day are converted to seconds since the first row. Empty fields are NaN.
/// Throws InputError "FILE:LINE: ..." if the file is no table; an error in a single column becomes
/// LoggedSignal::fault of its signal.
Log read_table_log(const std::filesystem::path& file, const TableOptions& options);

}  // namespace fidservo::imports
