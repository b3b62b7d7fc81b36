// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/import/guarded.h"

#include "core/input_error.h"
#include "core/sanitizer.h"
#include "src/import/interrupted.h"
#include "src/import/log_bytes.h"

#include <array>
#include <chrono>
#include <csignal>
#include <cstring>
#include <exception>
#include <new>
#include <thread>

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace fidservo::imports {
namespace {

enum class Ending : char { log = 'L', fault = 'F' };

constexpr int out_of_memory = 77;

void bound_this_process(const ReadingLimits& limits) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) ::signal(signal, SIG_DFL);
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    const rlimit memory{limits.bytes, limits.bytes}, none{0, 0};
    const rlimit time{limits.processor_s, limits.processor_s + 1};
    if (!has_sanitizer) ::setrlimit(RLIMIT_AS, &memory);
    ::setrlimit(RLIMIT_CPU, &time);
    ::setrlimit(RLIMIT_CORE, &none);
}

bool write_all(int descriptor, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t count = ::write(descriptor, bytes.data(), bytes.size());
        if (count <= 0) return false;
        bytes.remove_prefix(static_cast<std::size_t>(count));
    }
    return true;
}

[[noreturn]] void read_and_end(const std::filesystem::path& file, LogReader reader, int descriptor,
                               const ReadingLimits& limits) {
    bound_this_process(limits);
    int code = out_of_memory;
    try {
        const LogOrFault answer = reader(file.c_str());
        const char ending = static_cast<char>(answer ? Ending::log : Ending::fault);
        const bool is_written = write_all(descriptor, {&ending, 1}) &&
                                write_all(descriptor, answer ? to_bytes(*answer) : answer.error());
        code = is_written ? 0 : out_of_memory;
    } catch (const std::bad_alloc&) {
        code = out_of_memory;
    } catch (const std::exception& error) {
        const char ending = static_cast<char>(Ending::fault);
        code = write_all(descriptor, {&ending, 1}) && write_all(descriptor, error.what()) ? 0 : out_of_memory;
    }
    ::_exit(code);
}

std::string all_bytes(int descriptor) {
    std::string bytes(static_cast<std::size_t>(std::max<off_t>(0, ::lseek(descriptor, 0, SEEK_END))), '\0');
    ::lseek(descriptor, 0, SEEK_SET);
    for (std::size_t done = 0; done < bytes.size();) {
        const ssize_t count = ::read(descriptor, bytes.data() + done, bytes.size() - done);
        if (count <= 0) return bytes.substr(0, done);
        done += static_cast<std::size_t>(count);
    }
    return bytes;
}

std::string how_it_ended(int status, const ReadingLimits& limits) {
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
        return fmt::format("reading it took more than {} s of the processor", limits.processor_s);
    if (WIFSIGNALED(status) && (WTERMSIG(status) == SIGINT || WTERMSIG(status) == SIGTERM))
        return "reading it was interrupted";
    if (WIFSIGNALED(status))
        return fmt::format("the format's library crashed on it ({})", ::strsignal(WTERMSIG(status)));
    if (WEXITSTATUS(status) == out_of_memory)
        return fmt::format("reading it takes more memory than the {} GiB that it may", limits.bytes >> 30U);
    return fmt::format("the format's library ended the reading process (exit code {})", WEXITSTATUS(status));
}

class Descriptor {
  public:
    explicit Descriptor(int number) : number_(number) {}
    ~Descriptor() {
        if (number_ >= 0) ::close(number_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int number() const { return number_; }

  private:
    int number_;
};

/// Waits for a process, and ends it where the user interrupts.
int status_at_end(pid_t child) {
    constexpr auto pause = std::chrono::milliseconds(5);
    int status = 0;
    for (pid_t ended = 0; ended != child; ended = ::waitpid(child, &status, WNOHANG)) {
        if (ended < 0 && errno != EINTR) break;
        if (interrupt_requested()) ::kill(child, SIGKILL);
        std::this_thread::sleep_for(pause);
    }
    return status;
}

}  // namespace

Log read_guarded(const std::filesystem::path& file, LogReader reader, const ReadingLimits& limits) {
    const Descriptor answer(::memfd_create("fidservo-import", MFD_CLOEXEC));
    const pid_t child = answer.number() < 0 ? -1 : ::fork();
    if (child == 0) read_and_end(file, reader, answer.number(), limits);
    if (child < 0)
        throw RunFault(
            fmt::format("{}: no process can be made to read it: {}", file.string(), std::strerror(errno)));
    const int status = status_at_end(child);
    end_if_interrupted();
    const auto fail = [&](std::string_view why) {
        throw InputError(fmt::format("{}: {}", file.string(), why));
    };
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) fail(how_it_ended(status, limits));
    const std::string bytes = all_bytes(answer.number());
    if (bytes.empty()) fail("the reading process gave no answer");
    if (bytes.front() == static_cast<char>(Ending::fault)) fail(bytes.substr(1));
    Log log = from_bytes(std::string_view(bytes).substr(1));
    log.file = file;
    return log;
}

}  // namespace fidservo::imports
