// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "core/time.h"

namespace fidservo {

/// A file descriptor that becomes readable when the signal is raised, and stays so until it is cleared; it
/// wakes a thread or a child process that waits for it. May be raised from any thread; neither raise() nor
/// clear() blocks.
class WakeSignal {
  public:
    /// Throws RunFault if the system gives no descriptor.
    WakeSignal();
    ~WakeSignal();
    WakeSignal(const WakeSignal&) = delete;
    WakeSignal& operator=(const WakeSignal&) = delete;

    void raise() const noexcept;
    void clear() const noexcept;
    void wait(TimeNs at_most_ns) const noexcept;
    int fd() const { return fd_; }

  private:
    int fd_;
};

}  // namespace fidservo
