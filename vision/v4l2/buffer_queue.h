// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The frames' memory, shared with the driver: a few buffers that are filled in turn.
//
// A buffer is owned by the driver from when it is queued, and by a Lease from when it is taken, filled, until
// the lease ends and queues it again. One thread takes buffers; leases may end on any thread, also after the
// queue was stopped: the memory stays mapped until the last lease has gone.
#include "core/result.h"
#include "core/time.h"
#include "vision/v4l2/capture_settings.h"
#include "vision/v4l2/device.h"
#include "vision/v4l2/frame_time.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

namespace fidservo::vision::v4l2 {

/// What the driver says about a filled buffer.
struct FilledBuffer {
    std::uint32_t index = 0;
    std::size_t used_bytes = 0;
    std::uint32_t sequence = 0;
    bool damaged = false;  ///< V4L2_BUF_FLAG_ERROR
    Stamp stamp;
};

class Lease;

class BufferQueue : public std::enable_shared_from_this<BufferQueue> {
  public:
    /// Allocates buffers, queues them and starts the stream. Where the driver lacks the kind of memory asked
    /// for, the other kind is used. Throws RunFault.
    static std::shared_ptr<BufferQueue> start(Device device, Memory memory, std::size_t frame_bytes);
    ~BufferQueue();
    BufferQueue(const BufferQueue&) = delete;
    BufferQueue& operator=(const BufferQueue&) = delete;

    /// The oldest filled buffer; empty if none is filled. Fails with Reason::device.
    Result<std::optional<Lease>> take();

    /// Stops the stream, and closes the device.
    void stop();

    const Device& device() const { return device_.value(); }
    Memory memory() const { return memory_; }
    /// How many buffers are queued for the driver to fill.
    std::size_t with_driver() const;
    std::size_t size() const { return buffers_.size(); }

  private:
    friend class Lease;

    struct Unmap {
        std::size_t bytes = 0;
        Memory memory = Memory::mapped;
        void operator()(std::byte* start) const;
    };
    using Buffer = std::unique_ptr<std::byte, Unmap>;

    BufferQueue(Device device, std::size_t frame_bytes);
    int request_buffers(Memory memory);
    void allocate(std::uint32_t count);
    void start_stream();
    int queue(std::uint32_t index);
    void give_back(std::uint32_t index);

    std::size_t frame_bytes_;
    Memory memory_ = Memory::mapped;
    std::vector<Buffer> buffers_;
    mutable std::mutex mutex_;      ///< guards the members below
    std::optional<Device> device_;  ///< empty: stopped
    std::size_t with_driver_ = 0;
};

/// A filled buffer that the driver gets back when the lease ends.
class Lease {
  public:
    Lease(std::shared_ptr<BufferQueue> queue, const FilledBuffer& filled)
        : queue_(std::move(queue)), filled_(filled) {}
    ~Lease();
    Lease(Lease&&) noexcept = default;
    Lease& operator=(Lease&& other) noexcept;
    Lease(const Lease&) = delete;
    Lease& operator=(const Lease&) = delete;

    const FilledBuffer& filled() const { return filled_; }
    std::span<const std::byte> bytes() const;
    const BufferQueue& queue() const { return *queue_; }

  private:
    std::shared_ptr<BufferQueue> queue_;
    FilledBuffer filled_;
};

}  // namespace fidservo::vision::v4l2
