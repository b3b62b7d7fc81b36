// SPDX-License-Identifier: GPL-3.0-or-later
#include "control/guardian_process.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <fstream>
#include <string>

#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace fidservo::control {

namespace {

/// In timeouts: a simulation's missing heartbeat is excused for so long by a busy machine.
constexpr int process_patience = 100;

/// Leaves the program's session, terminal, pipes and files: a shell waits for nothing but the program itself,
/// and Ctrl-C reaches the program alone.
void leave_the_program(const GuardianPipes& pipes) {
    ::setsid();
    ::prctl(PR_SET_NAME, "fidservo-guard");
    const int null_fd = ::open("/dev/null", O_RDWR);
    for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(null_fd, fd);
    const auto [low, high] = std::minmax(pipes.ready_fd, pipes.wake_fd);
    ::close_range(STDERR_FILENO + 1, static_cast<unsigned>(low) - 1, 0);
    ::close_range(static_cast<unsigned>(low) + 1, static_cast<unsigned>(high) - 1, 0);
    ::close_range(static_cast<unsigned>(high) + 1, ~0U, 0);
}

void say(int fd, std::string_view text) noexcept {
    [[maybe_unused]] const ssize_t written = ::write(fd, text.data(), text.size());
}

/// Empty if the board cannot be opened; the program has then been told why.
std::unique_ptr<OutputBoard> open_and_report(const BoardFactory& open_board, int ready_fd) noexcept {
    try {
        auto board = open_board();
        if (board->write({})) {
            say(ready_fd, guardian_is_ready);
            return board;
        }
        say(ready_fd, "the output board refuses commands");
    } catch (const std::exception& error) {
        say(ready_fd, error.what());
    }
    return nullptr;
}

/// The state of a process as in proc(5), e.g. 'R' running or ready to run, 'T' stopped.
char process_state(pid_t process) {
    std::ifstream in("/proc/" + std::to_string(process) + "/stat");
    std::string text;
    std::getline(in, text);
    const std::size_t name_end = text.rfind(") ");  // the name itself may hold spaces and brackets
    return name_end == std::string::npos ? 'X' : text[name_end + 2];
}

class Watch {
  public:
    Watch(GuardianMemory& memory, const GuardianOptions& options, OutputBoard& board, pid_t program)
        : memory_(memory),
          options_(options),
          board_(board),
          program_(program),
          heartbeat_(options.timeout),
          last_chance_(process_patience * options.timeout) {}

    /// One look at the program while it lives.
    void look() {
        memory_.looks.fetch_add(1, std::memory_order_relaxed);
        if (memory_.trip.load() != Trip::none) return;
        if (stands_still()) {
            trip(Trip::stalled, "heartbeat missing");
        } else if (!follow()) {
            trip(Trip::board_refused, "the board refused a command");
        }
    }

    /// The last act. True if the board confirmed.
    bool end() noexcept {
        const bool confirmed = board_.write({});
        if (!memory_.finish.load()) log("program ended without saying so", confirmed);
        return confirmed;
    }

  private:
    /// Whether the loop counts as stopped. A loop that must run at 1 kHz does as soon as its heartbeat is
    /// missing; a simulation, which may only be short of processor time, does so later, or at once if its
    /// process is not able to run.
    bool stands_still() {
        const std::uint64_t beats = memory_.beats.load(std::memory_order_acquire);
        const bool missing = heartbeat_.look(beats);
        const bool long_missing = last_chance_.look(beats);
        if (beats == 0 || !missing) return false;
        if (options_.heartbeat == Heartbeat::loop || long_missing) return true;
        return std::string_view("RSD").find(process_state(program_)) == std::string_view::npos;
    }

    bool follow() noexcept {
        const std::uint64_t command = memory_.command.load(std::memory_order_acquire);
        if (command == on_board_) return true;
        on_board_ = command;
        return board_.write(unpacked(command));
    }

    void trip(Trip why, std::string_view text) noexcept {
        const bool confirmed = board_.write({});
        memory_.trip.store(why);
        log(text, confirmed);
    }

    void log(std::string_view text, bool confirmed) const noexcept {
        log_guardian(options_, std::string(text) + (confirmed ? "; macro 0 V, micro 0 V"
                                                              : "; the board did not confirm 0 V"));
    }

    GuardianMemory& memory_;
    const GuardianOptions& options_;
    OutputBoard& board_;
    pid_t program_;
    Standstill heartbeat_;
    Standstill last_chance_;
    std::uint64_t on_board_ = packed({});
};

}  // namespace

void be_guardian(GuardianMemory& memory, const GuardianOptions& options, const BoardFactory& open_board,
                 const GuardianPipes& pipes, pid_t program) {
    leave_the_program(pipes);
    take_real_time_priority();
    // Readable when the program ends. Its number cannot have passed to another process if it still is our
    // parent.
    const int program_fd = open_process(program);
    const bool orphan = ::getppid() != program;
    auto board = open_and_report(open_board, pipes.ready_fd);
    ::close(pipes.ready_fd);
    if (board == nullptr) ::_exit(EXIT_FAILURE);

    Watch watch(memory, options, *board, program);
    for (bool ended = orphan; !ended;) {
        std::array<pollfd, 2> events{{{program_fd, POLLIN, 0}, {pipes.wake_fd, POLLIN, 0}}};
        ::poll(events.data(), events.size(), static_cast<int>(look_period.count()));
        if (events[1].revents != 0) {
            std::uint64_t wakes = 0;
            [[maybe_unused]] const ssize_t got = ::read(pipes.wake_fd, &wakes, sizeof wakes);
        }
        ended = events[0].revents != 0 || memory.finish.load() || ::getppid() != program;
        if (!ended) watch.look();
    }
    const bool confirmed = watch.end();
    board.reset();
    ::_exit(confirmed ? EXIT_SUCCESS : EXIT_FAILURE);
}

int open_process(pid_t process) {
    return static_cast<int>(::syscall(SYS_pidfd_open, process, 0));
}

bool take_real_time_priority() noexcept {
    const sched_param lowest{.sched_priority = ::sched_get_priority_min(SCHED_FIFO)};
    return ::sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &lowest) == 0;
}

void log_guardian(const GuardianOptions& options, std::string_view text) noexcept {
    if (options.log_file.empty()) return;
    const int fd = ::open(options.log_file.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
    if (fd < 0) return;
    const std::time_t now = std::time(nullptr);
    std::tm utc{};
    ::gmtime_r(&now, &utc);
    std::array<char, 32> time{};
    std::strftime(time.data(), time.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
    say(fd, std::string(time.data()) + " guardian: " + std::string(text) + "\n");
    ::close(fd);
}

}  // namespace fidservo::control
