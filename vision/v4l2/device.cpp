// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/v4l2/device.h"

#include "core/failure.h"

#include <cerrno>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace fidservo::vision::v4l2 {

namespace {

std::string words_of(int error) {
    switch (error) {
        case EACCES:
            return "permission denied; is the user in the group video?";
        case EBUSY:
            return "in use by another program";
        case ENODEV:
            return "the camera is gone (unplugged?)";
        default:
            return std::generic_category().message(error);
    }
}

}  // namespace

Result<Device> Device::open(const std::filesystem::path& node) {
    const int fd = ::open(node.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    if (fd < 0)
        return failure(Reason::device,
                       fmt::format("{}: cannot be opened: {}", node.string(), words_of(errno)));
    return Device(node, fd);
}

Device::~Device() {
    if (fd_ >= 0) ::close(fd_);
}

Device::Device(Device&& other) noexcept : node_(std::move(other.node_)), fd_(std::exchange(other.fd_, -1)) {}

int Device::request(unsigned long code, void* argument) const noexcept {
    while (::ioctl(fd_, code, argument) != 0)
        if (errno != EINTR) return errno;
    return 0;
}

std::string Device::refusal(std::string_view what, int error) const {
    return fmt::format("{}: {}: {}", node_.string(), what, words_of(error));
}

}  // namespace fidservo::vision::v4l2
