// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The fake driver's state and what requests do to it; umockdev's side is in fake_camera.cpp.
#include "tests/devices/fake_camera.h"

#include <deque>
#include <map>
#include <mutex>

#include <linux/videodev2.h>

namespace fidservo::devices {

/// Reads and writes the memory to which a request's argument points, in the program.
struct Pointed {
    std::function<bool(std::size_t offset_of_pointer, std::vector<std::byte>& copy)> read;
    std::function<bool(std::size_t offset_of_pointer, const std::vector<std::byte>& bytes)> write;
};

struct FakeCamera::State {
    explicit State(FakeProperties given);

    /// @param argument  the request's own copy, changed as the driver would
    /// @return 0, or the error number
    int answer(unsigned long request, std::vector<std::byte>& argument, const Pointed& pointed);

    mutable std::mutex mutex;
    FakeProperties properties;
    v4l2_pix_format current{};
    std::deque<FakeFrame> exposed;
    std::deque<std::uint32_t> queued;
    std::map<std::uint32_t, unsigned long> user_memory;
    std::size_t dropped = 0;
    std::uint32_t memory = 0;
    bool unplugged = false;
    bool streaming = false;
    int node_fd = -1;  ///< the file that stands for the node; its contents are the mapped buffers

  private:
    bool waiting_is_empty() const;
    int capability(v4l2_capability& answer) const;
    int list_format(v4l2_fmtdesc& answer) const;
    int list_size(v4l2_frmsizeenum& answer) const;
    int list_rate(v4l2_frmivalenum& answer) const;
    int set_format(v4l2_format& format);
    int rate(v4l2_streamparm& answer) const;
    int describe_control(v4l2_query_ext_ctrl& answer) const;
    int exchange_control(bool set, const Pointed& pointed);
    int give_buffers(v4l2_requestbuffers& request);
    int describe_buffer(v4l2_buffer& buffer) const;
    int queue(v4l2_buffer& buffer);
    int dequeue(v4l2_buffer& buffer);
};

/// How far apart the mapped buffers are in the node's file.
inline constexpr std::size_t buffer_stride = 1U << 20U;
inline constexpr std::uint32_t most_buffers = 8;

}  // namespace fidservo::devices
