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
    bool deaf = false;  ///< accepts values and does not apply them
};

struct FakeFormat {
    std::uint32_t fourcc;
    int width_px, height_px;
    std::uint32_t bytes_per_line;  ///< 0: compressed
};

struct FakeProperties {
    std::vector<FakeFormat> formats;
    std::vector<FakeControl> controls;
    bool maps = true;          ///< offers buffers of its own
    bool takes_memory = true;  ///< accepts the program's buffers
    int stream_error = 0;      ///< error number of VIDIOC_STREAMON
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

    /// Delivers the sensor's next frame. It is dropped if the program has queued no buffer.
    void expose(FakeFrame frame);
    /// Frames that the program has not fetched yet.
    std::size_t waiting() const;
    std::size_t queued_buffers() const;
    std::size_t dropped() const;

    /// From now on every request fails with ENODEV, until plug_in() and a new open.
    void unplug();
    void plug_in();
    /// Changes the format in force.
    void change_format(const FakeFormat& format);
    std::int64_t control(std::uint32_t id) const;

    struct State;

  private:
    std::shared_ptr<State> state_;
};

}  // namespace fidservo::devices
