// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What can be seen of MATLAB's files before their numbers are read: damage, and MATLAB's own objects
// (timetables, strings, datetimes), of which other programs can only tell names and classes.
#include <map>
#include <string>
#include <vector>

namespace fidservo::imports {

struct MatContents {
    std::map<std::string, std::string> faults{};  ///< why variables are not read, by their names
    std::vector<std::string> variables{};         ///< names of all others; of format 5 only
    std::string damage{};                         ///< what is damaged; empty: nothing that can be seen
};

/// Of a file of format 5: every compressed element is decompressed to its end and checked against its
/// checksum. Elements without compression have none.
MatContents look_into_mat5(const char* file);
/// Of a file of format 7.3, an HDF5 file.
MatContents look_into_mat73(const char* file);

/// One sentence: what the variable of a class that has no plain array is, and the line of MATLAB that saves
/// it as numbers.
std::string advice_on_object(const std::string& variable, const std::string& matlab_class);

}  // namespace fidservo::imports
