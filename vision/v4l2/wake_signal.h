#pragma once
#include "core/time.h"

namespace fidservo::vision::v4l2 {

/// A descriptor that becomes readable when it is raised, and stays so: it ends a thread's waiting. Raised
/// from any thread.
class WakeSignal {
  public:
    /// Throws RunFault.
    WakeSignal();
    ~WakeSignal();
    WakeSignal(const WakeSignal&) = delete;
    WakeSignal& operator=(const WakeSignal&) = delete;

    void raise() const noexcept;
    void wait(TimeNs at_most_ns) const noexcept;
    int fd() const { return fd_; }

  private:
    int fd_;
};

}  // namespace fidservo::vision::v4l2
