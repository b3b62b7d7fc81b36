// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// MATLAB's files by libmatio.
#include "src/import/log.h"

#include <string>

namespace fidservo::imports {

/// Formats 5 and 7.3: arrays column by column, fields as NAME.FIELD, cells as NAME{k}; of Simulink's
/// structures with time the signals by label, with their times. Crashes and loops of the library are for
/// read_guarded().
LogOrFault read_mat_file(const char* file);

/// Format 5: a structure for each part of a signal's name before the dot, its signals as fields; texts as
/// character arrays. What went wrong, or nothing.
std::string write_mat_file(const char* file, const Log& log);

}  // namespace fidservo::imports
