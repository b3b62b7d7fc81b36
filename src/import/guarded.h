// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Runs a library's reader in a process of its own, so that a file which makes the library crash, loop or
// exhaust memory causes an error message only.
#include "src/import/log.h"

#include <filesystem>

namespace fidservo::imports {

using LogReader = LogOrFault (*)(const char* file);

/// Limits of a reading process.
struct ReadingLimits {
    std::uint64_t bytes = std::uint64_t{8} << 30U;
    unsigned processor_s = 120;
};

/// The log that the reader returns, without its cameras. Throws InputError "FILE: ..." with the reader's
/// error or the reason why its process ended. Ctrl-C ends the process.
Log read_guarded(const std::filesystem::path& file, LogReader reader, const ReadingLimits& limits = {});

}  // namespace fidservo::imports
