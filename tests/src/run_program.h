// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Runs the real executable, for tests of exit codes and output on stderr.
#include "tests/src/temporary_folder.h"

#include <csignal>
#include <filesystem>
#include <string>
#include <vector>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace fidservo::testing {

struct ProgramRun {
    int exit_code;  ///< -1 if a signal ended it
    std::string out;
    std::string err;
};

/// @param working_folder   where it runs
/// @param most_bytes       no file may grow beyond this; stands for a full disk. 0: no limit
inline ProgramRun run_program(const std::vector<std::string>& arguments,
                              const std::filesystem::path& working_folder, rlim_t most_bytes = 0) {
    const TemporaryFolder streams;
    const pid_t child = ::fork();
    if (child == 0) {
        const auto redirect = [&](const char* name, int descriptor) {
            const int file = ::open((streams / name).c_str(), O_WRONLY | O_CREAT, 0600);
            ::dup2(file, descriptor);
        };
        redirect("out", STDOUT_FILENO);
        redirect("err", STDERR_FILENO);
        std::filesystem::current_path(working_folder);
        if (most_bytes > 0) {
            const rlimit limit{most_bytes, most_bytes};
            ::setrlimit(RLIMIT_FSIZE, &limit);
            std::signal(SIGXFSZ, SIG_IGN);
        }
        std::vector<char*> argv{const_cast<char*>("fidservo")};
        for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
        argv.push_back(nullptr);
        ::execv(FIDSERVO_PROGRAM, argv.data());
        ::_exit(127);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(streams / "out"), text_of(streams / "err")};
}

}  // namespace fidservo::testing
