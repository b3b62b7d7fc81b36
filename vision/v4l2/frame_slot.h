// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Between the thread that reads the camera and whoever wants a frame: one place, in which a newer frame takes
// the older one's.
#include "core/result.h"
#include "core/time.h"
#include "vision/camera.h"
#include "vision/v4l2/buffer_queue.h"
#include "vision/v4l2/capture_format.h"

#include <cstdint>
#include <mutex>
#include <optional>

namespace fidservo::vision::v4l2 {

/// A frame as the driver filled it, not looked at yet.
struct RawFrame {
    Lease lease;
    CaptureFormat format;
    TimeNs time_ns;
    TimeNs arrival_ns;
    std::uint64_t sequence;
};

/// Held for the time of a move only; nobody waits in it.
class FrameSlot {
  public:
    /// Takes the place of a frame that nobody has asked for, which counts as skipped.
    void put(RawFrame frame);
    /// The newest frame, once; empty if there is none or it arrived after now_ns; the failure for good once
    /// there is one.
    Result<std::optional<RawFrame>> take(TimeNs now_ns);
    /// No frame comes any more. The first reason stays.
    void fail(Failure why);
    /// Drops the frame that is there, if any: it is of a camera that was lost.
    void clear();

    void count(const FrameCounts& more);
    FrameCounts counts() const;

  private:
    mutable std::mutex mutex_;
    std::optional<RawFrame> newest_;
    std::optional<Failure> failure_;
    FrameCounts counts_;
};

}  // namespace fidservo::vision::v4l2
