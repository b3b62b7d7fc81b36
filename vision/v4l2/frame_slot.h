// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The hand-over between the thread that reads the camera and the thread that wants a frame: a single slot, in
// which a newer frame replaces the older one.
#include "core/result.h"
#include "core/time.h"
#include "vision/camera.h"
#include "vision/v4l2/buffer_queue.h"
#include "vision/v4l2/capture_format.h"

#include <cstdint>
#include <mutex>
#include <optional>

namespace fidservo::vision::v4l2 {

/// A frame as the driver filled it, not decoded yet.
struct RawFrame {
    Lease lease;
    CaptureFormat format;
    TimeNs time_ns;
    TimeNs arrival_ns;
    std::uint64_t sequence;
};

/// Its mutex is held for the time of a move only; no thread waits for a frame in it.
class FrameSlot {
  public:
    /// Puts a frame into the slot; a frame that it replaces, which was not taken, counts as skipped.
    void put(RawFrame frame);
    /// Takes the newest frame out of the slot. Empty if there is none or it arrived after now_ns. Once fail()
    /// was called, the failure is returned for ever.
    Result<std::optional<RawFrame>> take(TimeNs now_ns);
    /// States that no more frames come. Later reasons are ignored.
    void fail(Failure why);
    /// Drops a frame in the slot, which is of a camera that was lost.
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
