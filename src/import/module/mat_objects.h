// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// MATLAB's own objects (timetables, strings, datetimes), which other programs cannot read: only their names
// and classes.
#include <map>
#include <string>

namespace fidservo::imports {

/// What can be seen of the file's content without its data.
struct MatContents {
    std::map<std::string, std::string> objects{};  ///< class, by the variable's name
    std::string damage{};                          ///< where the file is truncated; empty: it is not
};

/// Of a file of format 5.
MatContents look_into_mat5(const char* file);
/// Of a file of format 7.3, an HDF5 file.
MatContents look_into_mat73(const char* file);

/// One sentence: what the variable is, and the line of MATLAB that saves it as numbers.
std::string advice_on_object(const std::string& variable, const std::string& matlab_class);

}  // namespace fidservo::imports
