// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A program that a test starts, watches and kills.
#include <chrono>
#include <csignal>
#include <string>
#include <vector>

#include <sys/types.h>

namespace fidservo::testing {

class ChildProcess {
  public:
    /// Starts a program, whose output (both streams) can be read here.
    explicit ChildProcess(const std::vector<std::string>& arguments);
    ~ChildProcess();  ///< kills it if it still runs
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    void send(int signal) const;
    /// Reads on until `text` was printed. False if the output ended or the time was over before that.
    bool prints(const std::string& text, std::chrono::milliseconds limit = std::chrono::seconds(30));
    /// Reads on until no process holds the program's output open any more, as in a shell's pipeline.
    bool output_ends(std::chrono::milliseconds limit = std::chrono::seconds(10));
    /// Waits for its end. The exit code, or minus the number of the signal that ended it.
    int wait();

    const std::string& output() const { return output_; }
    pid_t pid() const { return pid_; }

  private:
    bool read_some(std::chrono::steady_clock::time_point until);

    pid_t pid_ = -1;
    int output_fd_ = -1;
    bool output_ended_ = false;
    std::string output_;
};

}  // namespace fidservo::testing
