// SPDX-License-Identifier: GPL-3.0-or-later
#include "control/guardian.h"

#include "control/guardian_memory.h"
#include "control/guardian_process.h"
#include "core/failure.h"
#include "core/input_error.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <new>

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

namespace fidservo::control {

namespace {

constexpr int start_limit_ms = 10'000;
constexpr int finish_limit_ms = 2'000;
/// In timeouts: a guardian that does not look at the program for so long is taken for dead.
constexpr int guardian_patience = 10;

[[noreturn]] void throw_not_started(const char* what) {
    throw RunFault(std::string("the guardian process cannot be started: ") + what + ": " +
                   std::strerror(errno));
}

/// No signal handler of the program runs while this lives, nor in a process or thread that is started in it.
class SignalsBlocked {
  public:
    SignalsBlocked() {
        sigset_t all;
        ::sigfillset(&all);
        ::pthread_sigmask(SIG_SETMASK, &all, &before_);
    }
    ~SignalsBlocked() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
    SignalsBlocked(const SignalsBlocked&) = delete;
    SignalsBlocked& operator=(const SignalsBlocked&) = delete;

  private:
    sigset_t before_{};
};

bool readable_within(int fd, int limit_ms) {
    pollfd event{fd, POLLIN, 0};
    int ready = 0;
    do ready = ::poll(&event, 1, limit_ms);
    while (ready < 0 && errno == EINTR);
    return ready > 0;
}

/// What the guardian process says once its board is open, or why it is not.
std::string first_words(int ready_fd) {
    std::array<char, 512> text{};
    if (!readable_within(ready_fd, start_limit_ms)) return "the output board does not open";
    const ssize_t length = ::read(ready_fd, text.data(), text.size());
    return length > 0 ? std::string(text.data(), static_cast<std::size_t>(length)) : "it ended at once";
}

GuardianMemory* map_shared() {
    void* const shared =
        ::mmap(nullptr, sizeof(GuardianMemory), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (shared == MAP_FAILED) throw_not_started("shared memory");
    return new (shared) GuardianMemory;
}

}  // namespace

void Guardian::Unmap::operator()(GuardianMemory* memory) const {
    ::munmap(memory, sizeof(GuardianMemory));
}

Guardian::Guardian(GuardianOptions options, BoardFactory open_board)
    : options_(std::move(options)), open_board_(std::move(open_board)), memory_(map_shared()) {
    options_.log_file = options_.log_file.empty() ? "" : std::filesystem::absolute(options_.log_file);
    start();
    const SignalsBlocked no_signals;
    watcher_ = std::jthread([this](const std::stop_token& stop) { watch(stop); });
}

void Guardian::start() {
    std::array<int, 2> ready{};
    if (::pipe2(ready.data(), O_CLOEXEC) != 0) throw_not_started("pipe");
    {
        const SignalsBlocked no_signals;
        const pid_t program = ::getpid();
        process_ = ::fork();
        if (process_ == 0) be_guardian(*memory_, options_, open_board_, {ready[1], wake_.fd()}, program);
    }
    const int fork_error = errno;
    ::close(ready[1]);
    const std::string words = process_ > 0 ? first_words(ready[0]) : std::strerror(fork_error);
    ::close(ready[0]);
    if (words == guardian_is_ready) process_fd_ = open_process(process_);
    if (process_fd_ >= 0) return;
    if (process_ > 0) {
        ::kill(process_, SIGKILL);
        ::waitpid(process_, nullptr, 0);
    }
    throw RunFault("the guardian process cannot be started: " + words);
}

Guardian::~Guardian() {
    [[maybe_unused]] const Status confirmed = finish();
}

void Guardian::apply(const StageCommand& command) noexcept {
    hand_over(stopped_ ? StageCommand{} : command);
    // stop() may have come in between, its zero before this command: whoever is last has to write zero.
    if (stopped_) hand_over({});
}

void Guardian::stop() noexcept {
    stopped_ = true;
    hand_over({});
}

void Guardian::hand_over(const StageCommand& command) noexcept {
    memory_->command.store(packed(command));
    if (options_.heartbeat == Heartbeat::process) return;
    memory_->beats.fetch_add(1, std::memory_order_release);
    wake_.raise();
}

std::optional<std::string> Guardian::tripped() const {
    if (stopped_) return "stopped by the user: motor and heater switched off";
    switch (memory_->trip.load(std::memory_order_relaxed)) {
        case Trip::none:
            return std::nullopt;
        case Trip::stalled:
            return "the program stood still for more than " + std::to_string(options_.timeout.count()) +
                   " ms: the guardian has switched motor and heater off";
        case Trip::board_refused:
            return "the output board refused a command: motor and heater switched off";
        case Trip::guardian_lost:
            return "the guardian process was lost: motor and heater switched off";
    }
    return std::nullopt;
}

void Guardian::watch(const std::stop_token& stop) {
    take_real_time_priority();
    Standstill guardian(guardian_patience * options_.timeout);
    while (!stop.stop_requested()) {
        if (options_.heartbeat == Heartbeat::process) memory_->beats.fetch_add(1, std::memory_order_release);
        const bool ended = readable_within(process_fd_, static_cast<int>(look_period.count()));
        if (ended || guardian.look(memory_->looks.load(std::memory_order_relaxed))) return take_over();
    }
}

void Guardian::take_over() noexcept {
    ::kill(process_, SIGKILL);  // it may merely be stopped; its number is ours until we wait for it
    try {
        off_after_loss_ = open_board_()->write({});
        log_guardian(options_, off_after_loss_ ? "lost; the program set macro 0 V, micro 0 V"
                                               : "lost; the board did not confirm 0 V");
    } catch (const std::exception& error) {
        log_guardian(options_, std::string("lost; the board cannot be opened: ") + error.what());
    }
    memory_->trip.store(Trip::guardian_lost);
}

Status Guardian::finish() {
    if (process_ < 0) return {};
    watcher_.request_stop();
    if (watcher_.joinable()) watcher_.join();
    if (memory_->trip.load() != Trip::guardian_lost) {
        memory_->finish.store(true);
        wake_.raise();
        if (!readable_within(process_fd_, finish_limit_ms)) take_over();
    }
    int exit_status = 0;
    ::waitpid(process_, &exit_status, 0);
    ::close(process_fd_);
    process_ = -1;
    if (off_after_loss_ || (WIFEXITED(exit_status) && WEXITSTATUS(exit_status) == 0)) return {};
    return failure(Reason::device, "the output board did not confirm that motor and heater are off");
}

}  // namespace fidservo::control
