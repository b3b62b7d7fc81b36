// SPDX-License-Identifier: GPL-3.0-or-later
// Tasks in processes: what one of them does to itself, the others do not feel.
#include "src/fleet/workers.h"

#include "core/input_error.h"
#include "core/sanitizer.h"
#include "tests/src/temporary_folder.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

namespace fidservo::fleet {
namespace {

using testing::TemporaryFolder;

using Ends = std::map<std::size_t, TaskEnd>;

/// Done once by each process that a task had.
std::size_t count_attempt(const TemporaryFolder& folder, std::size_t task) {
    const auto file = folder / std::to_string(task);
    std::ofstream(file, std::ios::app) << 'x';
    return std::filesystem::file_size(file);
}

Ends ends_of(std::size_t tasks, const TaskWork& work, const WorkerOptions& options,
             WorkerCount* count = nullptr) {
    std::vector<std::size_t> numbers;
    for (std::size_t k = 0; k < tasks; ++k) numbers.push_back(k);
    Ends ends;
    const WorkerCount counted = run_in_processes(
        numbers, work, options, [&](std::size_t task, const TaskEnd& end) { ends[task] = end; });
    if (count != nullptr) *count = counted;
    return ends;
}

TaskEnd made(std::string file) {
    return {Outcome::made, "", std::move(file)};
}

TEST(Workers, EveryTask_IsDoneOnceInAProcessOfItsOwn) {
    const TemporaryFolder folder;
    const pid_t caller = ::getpid();
    const TaskWork work{
        .work =
            [&](std::size_t task) {
                count_attempt(folder, task);
                return made(::getpid() == caller ? "the caller's" : std::to_string(task * task));
            },
        .say_crash = {}};
    WorkerCount count;
    const Ends ends = ends_of(20, work, {.at_once = 3}, &count);
    EXPECT_EQ(count.made, 20U);
    for (std::size_t task = 0; task < 20; ++task) {
        EXPECT_EQ(ends.at(task).file, std::to_string(task * task));
        EXPECT_EQ(std::filesystem::file_size(folder / std::to_string(task)), 1U);
    }
}

TEST(Workers, Crash_IsTriedThreeTimesThenSaidAndTheOthersGoOn) {
    const TemporaryFolder folder;
    const TaskWork work{.work =
                            [&](std::size_t task) {
                                count_attempt(folder, task);
                                ::signal(SIGSEGV, SIG_DFL);  // a sanitizer's handler exits instead
                                if (task == 2) ::raise(SIGSEGV);
                                if (task == 4) std::abort();
                                return made("");
                            },
                        .say_crash =
                            [&](std::size_t, std::string_view signal) {
                                return TaskEnd{Outcome::failed, std::string(signal)};
                            }};
    WorkerCount count;
    const Ends ends = ends_of(6, work, {.at_once = 2}, &count);
    EXPECT_EQ(count.made, 4U);
    EXPECT_EQ(count.failed, 2U);
    EXPECT_EQ(ends.at(2).text, "SIGSEGV");
    EXPECT_EQ(ends.at(4).text, "SIGABRT");
    EXPECT_EQ(std::filesystem::file_size(folder / "2"), 3U);
}

TEST(Workers, KilledProcess_IsStartedAgainAndLeftUndoneAfterThree) {
    const TemporaryFolder folder;
    const TaskWork work{.work =
                            [&](std::size_t task) {
                                if (count_attempt(folder, task) < 3 + task) ::raise(SIGKILL);
                                return made("");
                            },
                        .say_crash = {}};
    const Ends ends = ends_of(2, work, {.at_once = 1});
    EXPECT_EQ(ends.at(0).outcome, Outcome::made);
    EXPECT_EQ(ends.at(1).outcome, Outcome::undone);
    EXPECT_EQ(ends.at(1).text, "its process was ended by SIGKILL, 3 times");
}

TEST(Workers, MoreMemoryThanAllowed_LeavesTheTaskUndone) {
    if (has_sanitizer) GTEST_SKIP() << "a sanitizer's own maps exceed any limit";
    const TaskWork work{.work =
                            [&](std::size_t task) {
                                const std::vector<char> much((task + 1) * 400'000'000, 'x');
                                return made(std::to_string(much.back()));
                            },
                        .say_crash = {}};
    const Ends ends = ends_of(2, work, {.at_once = 1, .memory_bytes = 700'000'000});
    EXPECT_EQ(ends.at(0).outcome, Outcome::made);
    EXPECT_EQ(ends.at(1).outcome, Outcome::undone);
    EXPECT_EQ(ends.at(1).text, "it asked for more than the 700 MB that --memory-mb allows a task");
}

TEST(Workers, Fault_LeavesTheTaskUndoneWithItsLine) {
    const TaskWork work{.work = [](std::size_t) -> TaskEnd { throw RunFault("disk full"); }, .say_crash = {}};
    EXPECT_EQ(ends_of(1, work, {}).at(0).text, "disk full");
}

TEST(Workers, Interrupt_EndsThoseAtWorkAtOnce) {
    const TemporaryFolder folder;
    const TaskWork work{.work =
                            [&](std::size_t task) {
                                count_attempt(folder, task);
                                ::sleep(1000);
                                return made("");
                            },
                        .say_crash = {}};
    int asked = 0;
    WorkerCount count;
    const Ends ends = ends_of(5, work, {.at_once = 2, .interrupted = [&] { return ++asked > 3; }}, &count);
    EXPECT_TRUE(count.was_interrupted);
    EXPECT_TRUE(ends.empty());
    EXPECT_LT(::waitpid(-1, nullptr, WNOHANG), 0) << "a process is left";
}

TEST(Workers, KilledCaller_TakesItsProcessesWithIt) {
    const TemporaryFolder folder;
    const pid_t caller = ::fork();
    if (caller == 0) {
        const TaskWork work{.work =
                                [&](std::size_t) {
                                    std::ofstream(folder / "begun") << ::getpid() << '\n' << std::flush;
                                    std::filesystem::rename(folder / "begun", folder / "at-work");
                                    ::sleep(1000);
                                    return made("");
                                },
                            .say_crash = {}};
        ends_of(1, work, {});
        ::_exit(0);
    }
    while (!std::filesystem::exists(folder / "at-work")) ::usleep(1000);
    pid_t worker = 0;
    std::ifstream(folder / "at-work") >> worker;
    ::kill(caller, SIGKILL);
    ::waitpid(caller, nullptr, 0);
    for (int k = 0; k < 5000 && ::kill(worker, 0) == 0; ++k) {
        // A zombie that nobody has waited for is gone, too.
        std::ifstream stat("/proc/" + std::to_string(worker) + "/stat");
        std::string number, name, state;
        stat >> number >> name >> state;
        if (state == "Z") break;
        ::usleep(1000);
        ASSERT_LT(k, 4999) << "the process goes on";
    }
}

}  // namespace
}  // namespace fidservo::fleet
