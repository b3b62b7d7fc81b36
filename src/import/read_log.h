// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The one reader of other programs' logs: which format a file is in is told by what it begins with.
#include "src/files/table/table_structure.h"
#include "src/import/log.h"

#include <filesystem>

namespace fidservo::imports {

/// MATLAB's .mat, HDF5, rosbag2 (.db3, or its folder), a folder as EuRoC's, or a text table. Throws
/// InputError "FILE: ..." on what it cannot read; on formats that others read, with what makes one of these
/// of them.
/// @param table  what the user says of a text table
Log read_log(const std::filesystem::path& file, const TableOptions& table);

}  // namespace fidservo::imports
