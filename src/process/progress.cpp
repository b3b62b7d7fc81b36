// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/process/progress.h"

#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

namespace fidservo {

namespace {

using namespace std::chrono_literals;

constexpr auto bar_period = 100ms;
constexpr auto line_period = 5s;
constexpr std::size_t bar_width = 30;

}  // namespace

Progress::Progress(std::string what, std::size_t total)
    : what_(std::move(what)), total_(total), on_terminal_(::isatty(STDERR_FILENO) == 1) {}

void Progress::advance(std::size_t count) {
    done_ += count;
    const auto now = Clock::now();
    if (now - last_shown_ < (on_terminal_ ? Clock::duration(bar_period) : Clock::duration(line_period)))
        return;
    last_shown_ = now;
    show();
}

void Progress::finish() {
    show();
    if (on_terminal_) std::fputc('\n', stderr);
}

void Progress::show() {
    std::fputs((on_terminal_ ? "\r" + text() : text() + "\n").c_str(), stderr);
    std::fflush(stderr);
}

std::string Progress::text() const {
    const double elapsed_s = std::chrono::duration<double>(Clock::now() - start_).count();
    const double rate = elapsed_s > 0.0 ? static_cast<double>(done_) / elapsed_s : 0.0;
    if (total_ == 0) return fmt::format("{} {}, {:.1f}/s", done_, what_, rate);
    const std::size_t filled = std::min(bar_width, bar_width * done_ / total_);
    const std::string bar =
        on_terminal_ ? fmt::format("[{}{}] ", std::string(filled, '='), std::string(bar_width - filled, ' '))
                     : "";
    return fmt::format("{}{} of {} {}, {:.1f}/s", bar, done_, total_, what_, rate);
}

}  // namespace fidservo
