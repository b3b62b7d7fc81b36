// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the tasks of a fleet have in common, whatever they do.
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

/// How a fleet's tasks are run; nothing of it changes a result.
struct RunOptions {
    std::filesystem::path out;  ///< FLEET
    Shard shard;
    bool resume = false;             ///< FLEET has to be there
    std::size_t jobs = 0;            ///< tasks at a time; 0: as many as there are cores
    std::uint64_t memory_mb = 2000;  ///< of a task
};

/// Throws InputError where FLEET is not what it has to be.
ResultStore open_store(const RunOptions& options);

/// Whether a result's text says that its task failed, and why; empty: it was done. Throws RunFault where the
/// text is no result of this key.
std::string why_failed(const std::string& text, const ResultName& name, const std::filesystem::path& folder);

/// A result that is there, as the end of its task; empty: there is none.
std::optional<TaskEnd> end_if_there(const ResultStore& store, const ResultName& name);

/// Publishes a result that was made now. @param why  it is one that failed; empty: it is done
TaskEnd publish_result(const ResultStore& store, const ResultName& name, std::string text, std::string why);

/// Why there is no result where each process of a task was ended by a signal of its own.
std::string why_crashed(std::string_view signal);

/// A text in which a path stands as results note it, in place of how it was given.
std::string as_noted(std::string text, const std::filesystem::path& given, const std::string& noted);

struct FleetEnd {
    int exit_code = 0;  ///< done; 1: all have a result and some failed; 3: some have none
    std::map<std::size_t, std::string> done;  ///< by task: its result's file; of the tasks that did not fail
};

/// How a fleet's processes work.
WorkerOptions worker_options(const RunOptions& options);

/// Does a share of tasks in processes, shows how far they are, says each that has no good result, and counts
/// them at the end. Ends early where the user wants it.
/// @param what     "campaigns"
/// @param name_of  what a task is about, for people
FleetEnd run_fleet(const ResultStore& store, const RunOptions& options, const std::string& what,
                   std::size_t tasks, const TaskWork& work,
                   const std::function<std::string(std::size_t)>& name_of);

}  // namespace fidservo::fleet
