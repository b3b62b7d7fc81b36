// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// MATLAB's files by libmatio.
#include "src/import/log.h"

#include <string>

namespace fidservo::imports {

/// Reads formats 5 and 7.3. Each column of an array becomes a signal; fields are named NAME.FIELD, cells
/// NAME{k}; signals of Simulink's structures with time are named by their labels and have their times. The
/// library may crash or loop on damaged files: call it by read_guarded().
LogOrFault read_mat_file(const char* file);

/// Writes format 5: a signal A.B becomes the field B of a structure A; texts become character arrays.
/// @return an error message; empty on success
std::string write_mat_file(const char* file, const Log& log);

}  // namespace fidservo::imports
