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

/// Runs tasks, several at a time, each in its own forked process with one thread, so that a crash or a memory
/// leak of one task does not affect the others. If a signal ends a process, the task is tried again, three
/// times in all. After that, the crash is the task's result if the signal came from the program itself
/// (SIGSEGV, SIGABRT, ...); the task is left undone if it came from outside (SIGKILL, SIGTERM, ...). A task
/// is also left undone if it needs more memory than is allowed or if the disk fails. The processes end with
/// the caller, even if the caller is killed. On an interruption the running processes are killed; their tasks
/// have no result. The caller must have only one thread.
/// @param ended  called for each task that has ended
WorkerCount run_in_processes(std::span<const std::size_t> tasks, const TaskWork& work,
                             const WorkerOptions& options,
                             const std::function<void(std::size_t task, const TaskEnd&)>& ended);

}  // namespace fidservo::fleet
