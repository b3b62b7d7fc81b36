// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "core/time.h"

namespace fidservo {

/// A descriptor that becomes readable when it is raised, and stays so until it is cleared: it ends the
/// waiting of a thread, or of a child process. Raised from any thread; neither call waits.
class WakeSignal {
  public:
    /// Throws RunFault.
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
