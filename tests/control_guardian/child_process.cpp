// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/control_guardian/child_process.h"

#include "core/demand.h"

#include <array>
#include <cerrno>

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

namespace fidservo::testing {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

ChildProcess::ChildProcess(const std::vector<std::string>& arguments) {
    std::array<int, 2> output{};
    FIDSERVO_DEMAND(::pipe2(output.data(), O_CLOEXEC) == 0);
    std::vector<char*> argv;
    argv.reserve(arguments.size() + 1);
    for (const auto& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    pid_ = ::fork();
    FIDSERVO_DEMAND(pid_ >= 0);
    if (pid_ == 0) {
        ::dup2(output[1], STDOUT_FILENO);
        ::dup2(output[1], STDERR_FILENO);
        ::execv(argv[0], argv.data());
        ::_exit(127);
    }
    ::close(output[1]);
    output_fd_ = output[0];
}

ChildProcess::~ChildProcess() {
    if (pid_ > 0) {
        send(SIGKILL);
        wait();
    }
    ::close(output_fd_);
}

void ChildProcess::send(int signal) const {
    ::kill(pid_, signal);
}

bool ChildProcess::read_some(steady_clock::time_point until) {
    const auto left = std::chrono::ceil<milliseconds>(until - steady_clock::now());
    pollfd event{output_fd_, POLLIN, 0};
    if (output_ended_ || left.count() <= 0 || ::poll(&event, 1, static_cast<int>(left.count())) <= 0)
        return false;
    std::array<char, 4096> text{};
    const ssize_t length = ::read(output_fd_, text.data(), text.size());
    output_ended_ = length <= 0;
    if (length > 0) output_.append(text.data(), static_cast<std::size_t>(length));
    return !output_ended_;
}

bool ChildProcess::prints(const std::string& text, milliseconds limit) {
    const auto until = steady_clock::now() + limit;
    while (output_.find(text) == std::string::npos) {
        if (!read_some(until)) return false;
    }
    return true;
}

bool ChildProcess::output_ends(milliseconds limit) {
    const auto until = steady_clock::now() + limit;
    while (read_some(until)) {
    }
    return output_ended_;
}

int ChildProcess::wait() {
    int status = 0;
    while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
    }
    pid_ = -1;
    return WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status);
}

}  // namespace fidservo::testing
