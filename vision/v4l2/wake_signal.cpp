#include "vision/v4l2/wake_signal.h"

#include "core/failure.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

namespace fidservo::vision::v4l2 {

WakeSignal::WakeSignal() : fd_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
    if (fd_ < 0) throw RunFault("no descriptor left to wake the camera's thread with");
}

WakeSignal::~WakeSignal() {
    ::close(fd_);
}

void WakeSignal::raise() const noexcept {
    (void)::eventfd_write(fd_, 1);
}

void WakeSignal::wait(TimeNs at_most_ns) const noexcept {
    pollfd watched{fd_, POLLIN, 0};
    (void)::poll(&watched, 1, static_cast<int>(at_most_ns / ns_per_ms));
}

}  // namespace fidservo::vision::v4l2
