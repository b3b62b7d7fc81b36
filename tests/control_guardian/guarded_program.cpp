// SPDX-License-Identifier: GPL-3.0-or-later
// A program under a guardian, for the tests: drives both outputs until something ends it.
//
//     guarded_program REGISTERS LOG loop|process ENDING
//
// Prints "running" when the outputs are on. ENDING: "wait" runs until it is killed or the guardian trips (the
// reason is printed, exit code 3); the others end by themselves after 50 ms, in the way they are named for.
#include "control/guardian.h"
#include "control/guardian_process.h"

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <thread>

namespace {

using namespace std::chrono_literals;

void end_by(const std::string& ending, fidservo::control::Guardian& guardian) {
    if (ending == "finish") std::exit(guardian.finish() ? 0 : 1);
    if (ending == "exit") std::exit(0);
    if (ending == "abort") std::abort();
    if (ending == "segv") {
        std::signal(SIGSEGV, SIG_DFL);  // a sanitizer would make an ordinary exit of it
        std::raise(SIGSEGV);
    }
    if (ending == "throw") throw std::runtime_error("mid-run");
    if (ending == "stall") std::this_thread::sleep_for(300ms);
    if (ending == "kill-guardian") ::kill(guardian.pid(), SIGKILL);
    if (ending == "stop-guardian") ::kill(guardian.pid(), SIGSTOP);
}

int run(const std::string& registers, const std::string& log, const std::string& heartbeat,
        const std::string& ending) {
    using namespace fidservo::control;
    take_real_time_priority();  // as the loop of a real rig
    GuardianOptions options;
    options.heartbeat = heartbeat == "loop" ? Heartbeat::loop : Heartbeat::process;
    options.log_file = log;
    Guardian guardian(options, [registers] { return std::make_unique<SimulatedBoard>(registers); });
    for (int tick = 0;; ++tick) {
        guardian.apply({-4.5, 1.75});
        std::this_thread::sleep_for(1ms);
        if (const auto why = guardian.tripped()) {
            std::puts(why->c_str());
            return 3;
        }
        if (tick == 20) {
            std::puts("running");
            std::fflush(stdout);
        }
        if (tick == 70) end_by(ending, guardian);
    }
}

}  // namespace

// That nobody catches what "throw" throws is its purpose.
// NOLINTNEXTLINE(bugprone-exception-escape)
int main(int argc, char** argv) {
    if (argc != 5) return 2;
    const std::string ending = argv[4];
    if (ending != "throw-caught") return run(argv[1], argv[2], argv[3], ending);
    try {
        return run(argv[1], argv[2], argv[3], "throw");
    } catch (const std::exception&) {
        return 3;
    }
}
