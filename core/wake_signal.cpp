// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/wake_signal.h"

#include "core/input_error.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

namespace fidservo {

WakeSignal::WakeSignal() : fd_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
    if (fd_ < 0) throw RunFault("no descriptor left to wake a thread with");
}

WakeSignal::~WakeSignal() {
    ::close(fd_);
}

void WakeSignal::raise() const noexcept {
    (void)::eventfd_write(fd_, 1);
}

void WakeSignal::clear() const noexcept {
    eventfd_t raised = 0;
    (void)::eventfd_read(fd_, &raised);
}

void WakeSignal::wait(TimeNs at_most_ns) const noexcept {
    pollfd watched{fd_, POLLIN, 0};
    (void)::poll(&watched, 1, static_cast<int>(at_most_ns / ns_per_ms));
}

}  // namespace fidservo
