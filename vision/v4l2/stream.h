// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A camera that is opened, configured and streaming. For one thread.
#include "core/result.h"
#include "vision/v4l2/buffer_queue.h"
#include "vision/v4l2/capture_format.h"
#include "vision/v4l2/control_lock.h"

#include <filesystem>
#include <memory>
#include <string>

namespace fidservo::vision::v4l2 {

/// Why wait() returned.
enum class Wake {
    ready,   ///< a frame may be there
    broken,  ///< the device has an error; there may still be a frame
    late,    ///< nothing happened in the time allowed
    told,    ///< wake_fd became readable
};

class FrameStream {
  public:
    /// Throws InputError for settings that the camera cannot have, RunFault where the device fails.
    FrameStream(const std::filesystem::path& node, const CaptureSettings& settings);
    /// Stops the stream. Leases, and images that share their memory, remain valid.
    ~FrameStream();
    FrameStream(const FrameStream&) = delete;
    FrameStream& operator=(const FrameStream&) = delete;

    /// Waits for a frame. Fails with Reason::device if the source changed.
    /// @param wake_fd  another file descriptor whose readability ends the waiting
    Result<Wake> wait(int wake_fd, TimeNs at_most_ns);
    /// The oldest filled frame, as BufferQueue::take().
    Result<std::optional<Lease>> take() { return queue_->take(); }
    /// Fails with Reason::device if the format in force is no longer the one that was set.
    Status check_format() const;

    const std::string& card() const { return card_; }
    const CaptureFormat& format() const { return format_; }
    const ControlLock& lock() const { return lock_; }
    double frame_rate_hz() const { return frame_rate_hz_; }
    Memory memory() const { return queue_->memory(); }
    /// Whether a leased frame remains unchanged. v4l2loopback writes into it nevertheless.
    bool leased_frames_stay() const { return leased_frames_stay_; }

  private:
    bool source_changed();

    std::string card_;
    bool leased_frames_stay_ = true;
    CaptureFormat format_;
    ControlLock lock_;
    double frame_rate_hz_ = 0.0;
    std::shared_ptr<BufferQueue> queue_;
};

}  // namespace fidservo::vision::v4l2
