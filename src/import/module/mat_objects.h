// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Inspects MATLAB's files before their numbers are read: finds damage, and MATLAB's own objects (timetables,
// strings, datetimes), of which other programs can read only the names and classes.
#include <map>
#include <string>
#include <vector>

namespace fidservo::imports {

struct MatContents {
    std::map<std::string, std::string> faults{};  ///< why variables are not read, by their names
    std::vector<std::string> variables{};         ///< names of all others; of format 5 only
    std::string damage{};                         ///< description of a damage; empty: none was found
};

/// Inspects a file of format 5. Every compressed element is decompressed completely and compared with its
/// checksum; uncompressed elements have none.
MatContents look_into_mat5(const char* file);
/// Inspects a file of format 7.3, which is an HDF5 file.
MatContents look_into_mat73(const char* file);

/// A sentence for the user on a variable whose class is not a plain array, with the MATLAB command that saves
/// it as numbers.
std::string advice_on_object(const std::string& variable, const std::string& matlab_class);

}  // namespace fidservo::imports
