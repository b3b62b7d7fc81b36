// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The guardian's own side: what runs in its process.
#include "control/guardian.h"
#include "control/guardian_memory.h"

#include <string_view>

#include <sys/types.h>

namespace fidservo::control {

/// What the guardian process keeps of the program's open files.
struct GuardianPipes {
    int ready_fd;  ///< gets `guardian_is_ready` or the reason why the board could not be opened
    int wake_fd;   ///< readable when there is something new
};

inline constexpr std::string_view guardian_is_ready = "ready";

/// The life of the guardian process, from the fork on. Exit status 0 if the board confirmed its last zero.
/// @param program  the process that is guarded: the parent
[[noreturn]] void be_guardian(GuardianMemory& memory, const GuardianOptions& options,
                              const BoardFactory& open_board, const GuardianPipes& pipes, pid_t program);

/// A descriptor that becomes readable when the process ends; negative on failure. (The declaration of
/// pidfd_open() in glibc 2.36 does not link in C++.)
int open_process(pid_t process);

/// Lets the calling thread go before all ordinary ones, so that a busy machine does not delay it. Only for
/// threads that hardly use the processor. False where the user may not do that (ulimit -r, CAP_SYS_NICE).
bool take_real_time_priority() noexcept;

/// Appends "TIME guardian: TEXT" to the log file, if there is one and it can be written.
void log_guardian(const GuardianOptions& options, std::string_view text) noexcept;

}  // namespace fidservo::control
