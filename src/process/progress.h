// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How far a run is, on stderr: a bar on a terminal, otherwise a plain line every few seconds.
#include <chrono>
#include <cstddef>
#include <string>

namespace fidservo {

class Progress {
  public:
    /// @param what   what is counted, e.g. "images"
    /// @param total  how many there are; 0 if that is not known
    Progress(std::string what, std::size_t total);

    void advance(std::size_t count = 1);
    /// Says the last state and ends the line.
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
