// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A library's reader in a process of its own: a file that makes the library crash, loop or take all memory
// costs one line, not the program.
#include "src/import/log.h"

#include <filesystem>

namespace fidservo::imports {

using LogReader = LogOrFault (*)(const char* file);

/// What a reading process may take.
struct ReadingLimits {
    std::uint64_t bytes = std::uint64_t{8} << 30U;
    unsigned processor_s = 120;
};

/// What the reader makes of a file; cameras do not come through. Throws InputError "FILE: ...": its fault, or
/// how its process ended. Ctrl-C ends the process.
Log read_guarded(const std::filesystem::path& file, LogReader reader, const ReadingLimits& limits = {});

}  // namespace fidservo::imports
