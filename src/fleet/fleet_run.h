// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The common part of all fleet commands.
#include "src/fleet/result_store.h"
#include "src/fleet/shard.h"
#include "src/fleet/workers.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace fidservo::fleet {

/// How a fleet's tasks are run; these options do not change results.
struct RunOptions {
    std::filesystem::path out;  ///< FLEET
    Shard shard;
    bool resume = false;             ///< FLEET must exist
    std::size_t jobs = 0;            ///< number of tasks at a time; 0: the number of cores
    std::uint64_t memory_mb = 2000;  ///< limit for a task
};

/// Opens the results of the folder FLEET. Throws InputError if it does not exist although `resume` is set, or
/// cannot be used.
ResultStore open_store(const RunOptions& options);

/// Whether a result's text says that its task failed, and why; empty: it was done. Throws RunFault where the
/// text is no result of this key.
std::string why_failed(const std::string& text, const ResultName& name, const std::filesystem::path& folder);

/// The outcome of a task whose result exists; empty: there is no result.
std::optional<TaskEnd> end_if_there(const ResultStore& store, const ResultName& name);

/// Publishes a new result.
/// @param why  the reason, if the task failed; empty: it succeeded
TaskEnd publish_result(const ResultStore& store, const ResultName& name, std::string text, std::string why);

/// The reason given for a task whose processes all crashed by a signal.
std::string why_crashed(std::string_view signal);

/// The text with a path replaced by the form in which results note it.
std::string as_noted(std::string text, const std::filesystem::path& given, const std::string& noted);

struct FleetEnd {
    int exit_code = 0;  ///< 0: all done; 1: all have a result and some failed; 3: some have no result
    std::map<std::size_t, std::string> done;  ///< for each task that did not fail, its result's file
};

/// How a fleet's processes work.
WorkerOptions worker_options(const RunOptions& options);

/// Runs the tasks of a shard in processes, shows the progress, reports each task that failed or has no
/// result, and prints the counts at the end. Ends early if the user interrupts it.
/// @param what     "campaigns"
/// @param name_of  what a task is about, for people
FleetEnd run_fleet(const ResultStore& store, const RunOptions& options, const std::string& what,
                   std::size_t tasks, const TaskWork& work,
                   const std::function<std::string(std::size_t)>& name_of);

}  // namespace fidservo::fleet
