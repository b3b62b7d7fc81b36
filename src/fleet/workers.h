// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Runs tasks in processes of their own, one for each core.
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace fidservo::fleet {

/// How a task ended.
enum class Outcome {
    made,        ///< its result was made now
    failed,      ///< its result, made now, states the failure
    was_made,    ///< its result existed
    was_failed,  ///< its result existed and states a failure
    undone,      ///< it has no result, for a reason outside of the task; another run will make it
};

struct TaskEnd {
    Outcome outcome = Outcome::undone;
    std::string text = {};  ///< why it failed or was left undone, in one line
    std::string file = {};  ///< the result's name; empty where it has none
};

struct WorkerOptions {
    std::size_t at_once = 1;                 ///< number of processes at a time
    std::uint64_t memory_bytes = 0;          ///< limit for a process's data; 0: no limit
    std::function<bool()> interrupted = {};  ///< whether the user wants an end now
};

/// The work of a task, in its process.
struct TaskWork {
    std::function<TaskEnd(std::size_t task)> work;
    /// Makes the result of a task whose process crashed three times, with the name of the signal.
    std::function<TaskEnd(std::size_t task, std::string_view signal)> say_crash = {};
};

struct WorkerCount {
    std::size_t made = 0, failed = 0, was_made = 0, was_failed = 0, undone = 0;
    /// Interrupted by the user: the other tasks were not begun, or not finished.
    bool was_interrupted = false;

    std::size_t ended() const { return made + failed + was_made + was_failed + undone; }
};

/// Does tasks, some at a time, each in a process that is forked for it and works in one thread: whatever it
/// does to its memory, and however it ends, the others go on, and what it took is free afterwards. A process
/// that a signal ends is started again, three times in all; a task is then left undone if the signal came
/// from outside (SIGKILL, SIGTERM, ...), and its crash is its result if it was the program's own (SIGSEGV,
/// SIGABRT, ...). More memory than is allowed, and a disk that fails, leave a task undone, too. Processes end
/// with the caller, even if that is killed. Asked for an end, it kills those at work: their tasks have no
/// result yet. The caller has one thread.
/// @param ended  called for each task that has ended
WorkerCount run_in_processes(std::span<const std::size_t> tasks, const TaskWork& work,
                             const WorkerOptions& options,
                             const std::function<void(std::size_t task, const TaskEnd&)>& ended);

}  // namespace fidservo::fleet
