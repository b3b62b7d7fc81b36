// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/fleet/workers.h"

#include "core/input_error.h"
#include "core/parallel.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <deque>
#include <exception>
#include <new>
#include <optional>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <opencv2/core.hpp>
#include <opencv2/core/utility.hpp>
#include <poll.h>
#include <spdlog/spdlog.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace fidservo::fleet {
namespace {

constexpr std::size_t most_attempts = 3;
constexpr int poll_ms = 100;
constexpr std::uint64_t mega = 1'000'000;

struct Attempt {
    std::size_t task;
    std::size_t number = 1;
    int crashed_by = 0;  ///< not 0: the signal that is to be said
};

struct Process {
    Attempt attempt;
    pid_t id;
    int report;  ///< what it says at its end comes here
    std::string said{};
};

bool is_crash(int signal) {
    constexpr std::array crashes{SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGABRT, SIGTRAP, SIGSYS};
    return std::ranges::find(crashes, signal) != crashes.end();
}

std::string name_of_signal(int signal) {
    const char* name = ::sigabbrev_np(signal);
    return name != nullptr ? fmt::format("SIG{}", name) : fmt::format("signal {}", signal);
}

/// The task's process is quiet, works in one thread and ends with its parent, who alone hears of Ctrl-C.
void become_worker(pid_t parent, std::uint64_t memory_bytes) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(1);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_IGN);
    const rlimit no_core{0, 0};
    ::setrlimit(RLIMIT_CORE, &no_core);
    if (memory_bytes > 0) {
        const rlimit data{memory_bytes, memory_bytes};
        ::setrlimit(RLIMIT_DATA, &data);
    }
    spdlog::set_level(spdlog::level::off);
    use_cores(1);
    cv::setNumThreads(1);
}

TaskEnd undone(std::string why) {
    return {.outcome = Outcome::undone, .text = std::move(why)};
}

TaskEnd out_of_memory(const WorkerOptions& options) {
    return undone(options.memory_bytes == 0
                      ? std::string("the machine has no more memory")
                      : fmt::format("it asked for more than the {} MB that --memory-mb allows a task",
                                    options.memory_bytes / mega));
}

TaskEnd end_of(const Attempt& attempt, const TaskWork& work, const WorkerOptions& options) {
    try {
        if (attempt.crashed_by != 0) return work.say_crash(attempt.task, name_of_signal(attempt.crashed_by));
        return work.work(attempt.task);
    } catch (const std::bad_alloc&) {
        return out_of_memory(options);
    } catch (const cv::Exception& error) {
        if (error.code == cv::Error::StsNoMem) return out_of_memory(options);
        return undone(error.what());
    } catch (const std::exception& error) {
        return undone(error.what());
    }
}

void write_all(int descriptor, std::string_view text) {
    while (!text.empty()) {
        const ssize_t written = ::write(descriptor, text.data(), text.size());
        if (written < 0 && errno != EINTR) return;
        if (written > 0) text.remove_prefix(static_cast<std::size_t>(written));
    }
}

/// The parent takes it back by end_said().
std::string said(const TaskEnd& end) {
    return fmt::format("{}{}\n{}", static_cast<int>(end.outcome), end.file, end.text);
}

std::optional<TaskEnd> end_said(const std::string& text) {
    const auto line_end = text.find('\n');
    if (line_end == std::string::npos) return std::nullopt;
    return TaskEnd{static_cast<Outcome>(text.front() - '0'), text.substr(line_end + 1),
                   text.substr(1, line_end - 1)};
}

void count(WorkerCount& so_far, Outcome outcome) {
    switch (outcome) {
        case Outcome::made:
            ++so_far.made;
            break;
        case Outcome::failed:
            ++so_far.failed;
            break;
        case Outcome::was_made:
            ++so_far.was_made;
            break;
        case Outcome::was_failed:
            ++so_far.was_failed;
            break;
        case Outcome::undone:
            ++so_far.undone;
            break;
    }
}

class Workers {
  public:
    Workers(std::span<const std::size_t> tasks, const TaskWork& work, const WorkerOptions& options)
        : work_(work), options_(options) {
        for (const std::size_t task : tasks) waiting_.push_back({task});
    }
    ~Workers() { kill_all(); }
    Workers(const Workers&) = delete;
    Workers& operator=(const Workers&) = delete;

    WorkerCount run(const std::function<void(std::size_t, const TaskEnd&)>& ended) {
        while (!waiting_.empty() || !working_.empty()) {
            if (options_.interrupted && options_.interrupted()) {
                kill_all();
                count_.was_interrupted = true;
                break;
            }
            while (!waiting_.empty() && working_.size() < options_.at_once) start_next();
            for (Process& process : those_that_ended()) {
                const std::optional<TaskEnd> end = end_of_process(process);
                if (!end) continue;
                count(count_, end->outcome);
                ended(process.attempt.task, *end);
            }
        }
        return count_;
    }

  private:
    void start_next() {
        std::array<int, 2> pipe{};
        if (::pipe2(pipe.data(), O_CLOEXEC) != 0)
            throw RunFault(fmt::format("a task's process cannot be started: {}", std::strerror(errno)));
        const Attempt attempt = waiting_.front();
        std::fflush(nullptr);
        const pid_t parent = ::getpid(), id = ::fork();
        if (id < 0)
            throw RunFault(fmt::format("a task's process cannot be started: {}", std::strerror(errno)));
        if (id == 0) {
            ::close(pipe[0]);
            become_worker(parent, options_.memory_bytes);
            write_all(pipe[1], said(end_of(attempt, work_, options_)));
            ::_exit(0);
        }
        ::close(pipe[1]);
        waiting_.pop_front();
        working_.push_back({attempt, id, pipe[0]});
    }

    /// Waits for a while; takes out of those at work the ones that have closed their end.
    std::vector<Process> those_that_ended() {
        std::vector<pollfd> reports;
        for (const Process& process : working_) reports.push_back({process.report, POLLIN, 0});
        std::vector<Process> ended;
        if (::poll(reports.data(), reports.size(), poll_ms) <= 0) return ended;
        for (std::size_t k = reports.size(); k-- > 0;) {
            if (reports[k].revents == 0) continue;
            Process& process = working_[k];
            std::array<char, 4096> piece{};
            const ssize_t bytes = ::read(process.report, piece.data(), piece.size());
            if (bytes > 0) process.said.append(piece.data(), static_cast<std::size_t>(bytes));
            if (bytes > 0 || (bytes < 0 && errno == EINTR)) continue;
            ended.push_back(std::move(process));
            working_.erase(working_.begin() + static_cast<std::ptrdiff_t>(k));
        }
        return ended;
    }

    /// Empty: it is to be tried again.
    std::optional<TaskEnd> end_of_process(const Process& process) {
        ::close(process.report);
        int status = 0;
        while (::waitpid(process.id, &status, 0) < 0 && errno == EINTR) {
        }
        if (WIFEXITED(status)) {
            if (auto end = end_said(process.said)) return end;
            return undone(
                fmt::format("its process ended with exit code {} and said nothing", WEXITSTATUS(status)));
        }
        const int signal = WTERMSIG(status);
        Attempt again = process.attempt;
        if (again.crashed_by != 0)
            return undone(fmt::format("its process ended by {}, and so did the one that was to say so",
                                      name_of_signal(again.crashed_by)));
        if (again.number < most_attempts)
            ++again.number;
        else if (is_crash(signal))
            again.crashed_by = signal;
        else
            return undone(
                fmt::format("its process was ended by {}, {} times", name_of_signal(signal), most_attempts));
        waiting_.push_back(again);
        return std::nullopt;
    }

    void kill_all() {
        for (const Process& process : working_) ::kill(process.id, SIGKILL);
        for (const Process& process : working_) {
            ::close(process.report);
            while (::waitpid(process.id, nullptr, 0) < 0 && errno == EINTR) {
            }
        }
        working_.clear();
    }

    const TaskWork& work_;
    const WorkerOptions& options_;
    std::deque<Attempt> waiting_;
    std::vector<Process> working_;
    WorkerCount count_;
};

}  // namespace

WorkerCount run_in_processes(std::span<const std::size_t> tasks, const TaskWork& work,
                             const WorkerOptions& options,
                             const std::function<void(std::size_t, const TaskEnd&)>& ended) {
    return Workers(tasks, work, options).run(ended);
}

}  // namespace fidservo::fleet
