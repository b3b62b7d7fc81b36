// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/diagnose/search_progress.h"

#include <algorithm>
#include <cstddef>
#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

namespace fidservo::diagnose {

SearchProgress::SearchProgress(double at_most_s)
    : at_most_s_(at_most_s), on_terminal_(::isatty(STDERR_FILENO) == 1) {}

SearchProgress::~SearchProgress() {
    if (on_terminal_ && has_told_) std::fputs("\r\x1b[K", stderr);
}

void SearchProgress::tell(std::string_view what) {
    constexpr double bar_period_s = 0.1, line_period_s = 5.0;
    constexpr std::size_t bar_width = 20;
    const std::lock_guard lock(mutex_);
    const auto now = Clock::now();
    const auto seconds_since = [&](Clock::time_point then) {
        return std::chrono::duration<double>(now - then).count();
    };
    if (seconds_since(last_told_) < (on_terminal_ ? bar_period_s : line_period_s)) return;
    last_told_ = now;
    has_told_ = true;
    const double elapsed_s = seconds_since(start_);
    const double share = std::min(1.0, elapsed_s / at_most_s_);
    const auto filled = static_cast<std::size_t>(share * static_cast<double>(bar_width));
    if (on_terminal_)
        fmt::print(stderr, "\r\x1b[K[{}{}] {:.0f} s of at most {:.0f} s: {}", std::string(filled, '='),
                   std::string(bar_width - filled, ' '), elapsed_s, at_most_s_, what);
    else
        fmt::print(stderr, "{:.0f} s of at most {:.0f} s: {}\n", elapsed_s, at_most_s_, what);
    std::fflush(stderr);
}

}  // namespace fidservo::diagnose
