// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What runs in the guardian process itself.
#include "control/guardian.h"
#include "control/guardian_memory.h"

#include <string_view>

#include <sys/types.h>

namespace fidservo::control {

/// The file descriptors of the program that the guardian process keeps open.
struct GuardianPipes {
    /// The guardian writes `guardian_is_ready` to it, or the reason why the board could not be opened.
    int ready_fd;
    int wake_fd;  ///< readable when the program has something new for the guardian
};

inline constexpr std::string_view guardian_is_ready = "ready";

/// The guardian process's main function, from the fork on. Exit status 0 if the board confirmed its last
/// zero.
/// @param program  the process that is guarded: the parent
[[noreturn]] void be_guardian(GuardianMemory& memory, const GuardianOptions& options,
                              const BoardFactory& open_board, const GuardianPipes& pipes, pid_t program);

/// A file descriptor that becomes readable when a process ends; negative on failure. (The declaration of
/// pidfd_open() in glibc 2.36 does not link in C++.)
int open_process(pid_t process);

/// Gives the calling thread a real-time priority (SCHED_FIFO), so that a busy machine does not delay it. Only
/// for threads that use little processor time. False where the user may not do that (ulimit -r,
/// CAP_SYS_NICE).
bool take_real_time_priority() noexcept;

/// Appends "TIME guardian: TEXT" to the log file, if there is one and it can be written.
void log_guardian(const GuardianOptions& options, std::string_view text) noexcept;

}  // namespace fidservo::control
