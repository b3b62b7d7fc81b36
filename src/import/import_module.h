// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The libraries of other programs' formats (libmatio, libhdf5, SQLite), behind a module that is loaded when
// the first such file is opened: what they depend on takes longer to load than the program.
#include "src/import/log.h"

#include <filesystem>
#include <string>

namespace fidservo::imports {

/// What the module offers; its symbol is import_symbol, a constant of this type. Writers answer with what
/// went wrong, or nothing.
struct ImportModule {
    LogOrFault (*read_mat)(const char* file);
    LogOrFault (*read_hdf5)(const char* file);
    LogOrFault (*read_rosbag2)(const char* file);
    std::string (*write_mat)(const char* file, const Log& log);
    std::string (*write_hdf5)(const char* file, const Log& log);
};
inline constexpr const char* import_symbol = "fidservo_import_module";

/// Loads it at the first call. Throws InputError: it is not installed.
/// @param file  what is to be read or written, for the message
const ImportModule& import_module(const std::filesystem::path& file);

}  // namespace fidservo::imports
