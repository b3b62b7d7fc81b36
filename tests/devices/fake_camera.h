// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A V4L2 driver without a kernel: umockdev hands the program's requests to it. It has one node, /dev/video0,
// for the whole test program's life; every test gives it new properties.
//
// What it cannot show: its poll() is always ready, so that waiting costs a request every few milliseconds.
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace fidservo::devices {

struct FakeControl {
    std::uint32_t id;
    std::string name;
    std::uint32_t type;
    std::int64_t minimum, maximum, step, value;
    bool deaf = false;  ///< accepts values and keeps its own
};

struct FakeFormat {
    std::uint32_t fourcc;
    int width_px, height_px;
    std::uint32_t bytes_per_line;  ///< 0: compressed
};

struct FakeProperties {
    std::vector<FakeFormat> formats;
    std::vector<FakeControl> controls;
    bool maps = true;          ///< offers memory of its own
    bool takes_memory = true;  ///< offers to fill the program's
    int stream_error = 0;      ///< of VIDIOC_STREAMON
    std::string driver = "fake";
};

struct FakeFrame {
    std::vector<std::byte> bytes;
    std::uint32_t sequence = 0;
    std::uint32_t flags = 0;  ///< V4L2_BUF_FLAG_...
    std::int64_t stamp_us = 0;
};

class FakeCamera {
  public:
    /// Plugs the camera in.
    explicit FakeCamera(FakeProperties properties);
    /// Unplugs it.
    ~FakeCamera();
    FakeCamera(const FakeCamera&) = delete;
    FakeCamera& operator=(const FakeCamera&) = delete;

    /// The next frame that the sensor gives. It is dropped if the program has left no buffer.
    void expose(FakeFrame frame);
    /// Frames that the program has not fetched yet.
    std::size_t waiting() const;
    std::size_t queued_buffers() const;
    std::size_t dropped() const;

    /// From now on every request fails with ENODEV, until plug_in() and a new open.
    void unplug();
    void plug_in();
    /// The format in force is another one from now on.
    void change_format(const FakeFormat& format);
    std::int64_t control(std::uint32_t id) const;

    struct State;

  private:
    std::shared_ptr<State> state_;
};

}  // namespace fidservo::devices
