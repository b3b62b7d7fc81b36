// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// An open video device node.

#include "core/result.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace fidservo::vision::v4l2 {

/// The file descriptor is closed with its owner. request() may be called from several threads.
class Device {
  public:
    /// Opens a node for capture in non-blocking mode. Fails with Reason::device, with the system's message
    /// and, where permission is missing, the group that has it.
    static Result<Device> open(const std::filesystem::path& node);
    ~Device();
    Device(Device&& other) noexcept;
    Device& operator=(Device&&) = delete;
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    /// An ioctl, repeated if a signal interrupts it.
    /// @return 0, or the system's error number
    int request(unsigned long code, void* argument) const noexcept;

    int fd() const { return fd_; }
    const std::filesystem::path& node() const { return node_; }

    /// An error message: "NODE: what: the system's message".
    std::string refusal(std::string_view what, int error) const;

  private:
    Device(std::filesystem::path node, int fd) : node_(std::move(node)), fd_(fd) {}

    std::filesystem::path node_;
    int fd_;
};

}  // namespace fidservo::vision::v4l2
