// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Shows the progress of a run on stderr: a bar on a terminal, otherwise a plain line every few seconds.
#include <chrono>
#include <cstddef>
#include <string>

namespace fidservo {

class Progress {
  public:
    /// @param what   the things counted, e.g. "images"
    /// @param total  their number; 0 if unknown
    Progress(std::string what, std::size_t total);

    void advance(std::size_t count = 1);
    /// Shows the last state and ends the line.
    void finish();

  private:
    using Clock = std::chrono::steady_clock;

    void show();
    std::string text() const;

    std::string what_;
    std::size_t total_;
    std::size_t done_ = 0;
    bool on_terminal_;
    Clock::time_point start_ = Clock::now();
    Clock::time_point last_shown_ = start_;
};

}  // namespace fidservo
