// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/fleet/fleet_run.h"

#include "core/input_error.h"
#include "src/process/interrupt.h"
#include "src/process/progress.h"

#include <algorithm>
#include <cstdio>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

namespace fidservo::fleet {
namespace {

constexpr int exit_all_made = 0, exit_some_failed = 1, exit_some_undone = 3;

void say(const std::string& line) {
    // Over the progress bar, where stdout is the terminal that shows it.
    constexpr const char* erase_line = "\r\033[K";
    fmt::print("{}{}\n", ::isatty(STDOUT_FILENO) == 1 ? erase_line : "", line);
    std::fflush(stdout);
}

std::string summary(const WorkerCount& count, const std::string& what, std::size_t tasks,
                    const RunOptions& options) {
    std::string text = options.shard.of == 1 ? fmt::format("{} {}: ", tasks, what)
                                             : fmt::format("shard {}/{}, {} {}: ", options.shard.number,
                                                           options.shard.of, tasks, what);
    text += fmt::format("{} done", count.made + count.was_made);
    if (count.was_made > 0) text += fmt::format(" ({} were)", count.was_made);
    text += fmt::format(", {} failed", count.failed + count.was_failed);
    if (count.was_failed > 0) text += fmt::format(" ({} had)", count.was_failed);
    if (const std::size_t rest = tasks - count.ended() + count.undone; rest > 0)
        text += fmt::format(", {} have no result yet: the same command goes on", rest);
    return text;
}

std::string line_of(const TaskEnd& end) {
    switch (end.outcome) {
        case Outcome::failed:
            return "failed: " + end.text;
        case Outcome::was_failed:
            return "had failed: " + end.text;
        case Outcome::undone:
            return "left undone: " + end.text;
        case Outcome::made:
        case Outcome::was_made:
            break;
    }
    return {};
}

}  // namespace

ResultStore open_store(const RunOptions& options) {
    namespace fs = std::filesystem;
    std::error_code error;
    const auto type = fs::status(options.out, error).type();
    if (type != fs::file_type::not_found && type != fs::file_type::directory)
        throw InputError(fmt::format("--out: {}: is no folder", options.out.string()));
    if (options.resume && !fs::is_directory(options.out / "results", error))
        throw InputError(
            fmt::format("--resume: {}: there are no results to go on with; leave --resume out to begin",
                        options.out.string()));
    return ResultStore(options.out);
}

std::string why_failed(const std::string& text, const ResultName& name, const std::filesystem::path& folder) {
    const auto result = nlohmann::json::parse(text, nullptr, false);
    const auto is_text = [&](const char* key, std::string_view expected) {
        const auto found = result.find(key);
        return found != result.end() && found->is_string() &&
               found->get_ref<const std::string&>() == expected;
    };
    const std::filesystem::path file = folder / name.file();
    if (!result.is_object() || !is_text("format", result_format) || !is_text("key", name.key))
        throw RunFault(
            fmt::format("{}: is no result of this task: take it away to have it made", file.string()));
    if (is_text("status", "done")) return {};
    if (!is_text("status", "failed") || !result.contains("reason") || !result["reason"].is_string())
        throw RunFault(fmt::format("{}: its status is neither done nor failed with a reason", file.string()));
    return result["reason"].get<std::string>();
}

std::optional<TaskEnd> end_if_there(const ResultStore& store, const ResultName& name) {
    const auto text = store.find(name);
    if (!text) return std::nullopt;
    std::string why = why_failed(*text, name, store.folder());
    const Outcome outcome = why.empty() ? Outcome::was_made : Outcome::was_failed;
    return TaskEnd{outcome, std::move(why), name.file()};
}

TaskEnd publish_result(const ResultStore& store, const ResultName& name, std::string text, std::string why) {
    store.publish(name, text += '\n');
    const Outcome outcome = why.empty() ? Outcome::made : Outcome::failed;
    return {outcome, std::move(why), name.file()};
}

std::string why_crashed(std::string_view signal) {
    return fmt::format("the program crashed on it, by {}, each time it was tried", signal);
}

std::string as_noted(std::string text, const std::filesystem::path& given, const std::string& noted) {
    std::string path = given.string();
    while (path.size() > 1 && path.ends_with('/')) path.pop_back();
    if (path.empty() || path == noted) return text;
    for (std::size_t at = text.find(path); at != std::string::npos; at = text.find(path, at + noted.size()))
        text.replace(at, path.size(), noted);
    return text;
}

WorkerOptions worker_options(const RunOptions& options) {
    const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
    return {.at_once = options.jobs > 0 ? options.jobs : cores,
            .memory_bytes = options.memory_mb * 1'000'000,
            .interrupted = interrupt_requested};
}

FleetEnd run_fleet(const ResultStore& store, const RunOptions& options, const std::string& what,
                   std::size_t tasks, const TaskWork& work,
                   const std::function<std::string(std::size_t)>& name_of) {
    const std::vector<std::size_t> share = tasks_of(options.shard, tasks);
    watch_for_interrupts();
    store.sweep();
    Progress progress(what, share.size());
    FleetEnd all;
    const WorkerCount count =
        run_in_processes(share, work, worker_options(options), [&](std::size_t task, const TaskEnd& end) {
            if (const std::string line = line_of(end); !line.empty()) say(name_of(task) + ": " + line);
            if (end.outcome == Outcome::made || end.outcome == Outcome::was_made) all.done[task] = end.file;
            progress.advance();
        });
    progress.finish();
    store.sweep();
    if (count.was_interrupted) say(fmt::format("interrupted ({})", interrupt_name()));
    say(summary(count, what, share.size(), options));
    say("results: " + store.folder().string());
    const bool all_have_results = !count.was_interrupted && count.undone == 0;
    const bool some_failed = count.failed + count.was_failed > 0;
    all.exit_code = !all_have_results ? exit_some_undone : some_failed ? exit_some_failed : exit_all_made;
    return all;
}

}  // namespace fidservo::fleet
