// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The libraries for other programs' formats (libmatio, libhdf5, SQLite, libzstd), in a module that is loaded
// when the first such file is opened, since loading it takes longer than loading the program itself.
#include "src/import/log.h"

#include <filesystem>
#include <string>
#include <vector>

namespace fidservo::imports {

/// The module's functions; its exported symbol import_symbol is a constant of this type. Writers return an
/// error message, or an empty one.
struct ImportModule {
    LogOrFault (*read_mat)(const char* file);
    LogOrFault (*read_hdf5)(const char* file);
    /// Returns an error soon after is_interrupted() returns true.
    LogOrFault (*read_rosbag2)(const std::vector<std::filesystem::path>& files, bool (*is_interrupted)());
    std::string (*write_mat)(const char* file, const Log& log);
    std::string (*write_hdf5)(const char* file, const Log& log);
};
inline constexpr const char* import_symbol = "fidservo_import_module";

/// The module, which is loaded at the first call. Throws InputError if it is not installed.
/// @param file  the file to be read or written, for the message
const ImportModule& import_module(const std::filesystem::path& file);

}  // namespace fidservo::imports
