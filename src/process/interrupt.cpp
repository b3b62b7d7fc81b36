// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/process/interrupt.h"

#include <atomic>
#include <csignal>

#include <unistd.h>

namespace fidservo {

namespace {

constexpr int exit_code_forced = 128 + SIGINT;

/// The one thing that a signal handler can reach.
std::atomic<int> first_signal{0};
static_assert(std::atomic<int>::is_always_lock_free);

void on_signal(int signal) {
    int none = 0;
    if (!first_signal.compare_exchange_strong(none, signal) && signal == SIGINT) ::_exit(exit_code_forced);
}

bool is_ignored(int signal) {
    struct sigaction present {};
    ::sigaction(signal, nullptr, &present);
    return present.sa_handler == SIG_IGN;
}

}  // namespace

void watch_for_interrupts() {
    struct sigaction action {};
    action.sa_handler = on_signal;
    action.sa_flags = SA_RESTART;
    ::sigemptyset(&action.sa_mask);
    for (const int signal : {SIGINT, SIGTERM}) ::sigaction(signal, &action, nullptr);
    if (!is_ignored(SIGHUP)) ::sigaction(SIGHUP, &action, nullptr);
    ::signal(SIGPIPE, SIG_IGN);
}

bool interrupt_requested() noexcept {
    return first_signal.load(std::memory_order_relaxed) != 0;
}

void request_interrupt() noexcept {
    int none = 0;
    first_signal.compare_exchange_strong(none, SIGINT);
}

const char* interrupt_name() noexcept {
    switch (first_signal.load(std::memory_order_relaxed)) {
        case SIGINT:
            return "SIGINT";
        case SIGTERM:
            return "SIGTERM";
        case SIGHUP:
            return "SIGHUP";
        default:
            return "";
    }
}

}  // namespace fidservo
