// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The reader for all formats of other programs' logs; the format is recognised by the file's first bytes.
#include "src/files/table/table_structure.h"
#include "src/import/log.h"

#include <filesystem>
#include <vector>

namespace fidservo::imports {

/// Reads MATLAB's .mat, HDF5, rosbag2 (.db3 or the bag's folder), a folder in EuRoC's format, or a text
/// table. Throws InputError "FILE: ..." if the file cannot be read; for known formats of other programs the
/// message says how to convert them. Control characters in names are written as \x0A.
/// @param table  the user's statements about a text table
Log read_log(const std::filesystem::path& file, const TableOptions& table);

/// Reads all files of a run; the .db3 files of one bag become one log.
std::vector<Log> read_logs(const std::vector<std::filesystem::path>& files, const TableOptions& table);

}  // namespace fidservo::imports
