// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Shows on stderr what a diagnosis tries, and how much of its time is spent: one line that is overwritten on
// a terminal, otherwise a line every few seconds.
#include <chrono>
#include <mutex>
#include <string>
#include <string_view>

namespace fidservo::diagnose {

class SearchProgress {
  public:
    /// @param at_most_s  time limit of the diagnosis
    explicit SearchProgress(double at_most_s);
    /// Ends the line.
    ~SearchProgress();
    SearchProgress(const SearchProgress&) = delete;
    SearchProgress& operator=(const SearchProgress&) = delete;

    /// Any thread may call it.
    void tell(std::string_view what);

  private:
    using Clock = std::chrono::steady_clock;

    double at_most_s_;
    bool on_terminal_, has_told_ = false;
    Clock::time_point start_ = Clock::now(), last_told_ = start_;
    std::mutex mutex_;
};

}  // namespace fidservo::diagnose
