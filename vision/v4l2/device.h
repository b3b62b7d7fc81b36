// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// An open video node.

#include "core/result.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace fidservo::vision::v4l2 {

/// Closed with its owner. request() may be called from several threads.
class Device {
  public:
    /// Opens a node for capture, without waiting in later requests. Fails with Reason::device, saying what
    /// the system says and, where it is a matter of rights, which group helps.
    static Result<Device> open(const std::filesystem::path& node);
    ~Device();
    Device(Device&& other) noexcept;
    Device& operator=(Device&&) = delete;
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    /// An ioctl, repeated if a signal came between. @return 0, or the system's error number
    int request(unsigned long code, void* argument) const noexcept;

    int fd() const { return fd_; }
    const std::filesystem::path& node() const { return node_; }

    /// "NODE: what: the system's words".
    std::string refusal(std::string_view what, int error) const;

  private:
    Device(std::filesystem::path node, int fd) : node_(std::move(node)), fd_(fd) {}

    std::filesystem::path node_;
    int fd_;
};

}  // namespace fidservo::vision::v4l2
