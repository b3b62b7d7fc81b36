// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A camera behind Linux's video interface (V4L2).
//
// A thread of its own takes every frame from the driver at once and keeps the newest; older ones go back to
// the driver unread, so that poll() always returns a recent frame. Frames are converted to grey in poll(), on
// the caller's thread.
//
// Copies: GREY frames are handed out where the driver put them, and the driver gets the buffer back when the
// last cv::Mat that shares it has gone; while so many are kept that the driver would run out of buffers, they
// are copied instead, and so are those of a driver that overwrites leased frames. All other formats are
// converted once, without another copy.
#include "core/result.h"
#include "vision/camera.h"
#include "vision/v4l2/capture_settings.h"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace fidservo::vision::v4l2 {

/// A camera that Linux drives.
class V4l2Camera final : public Camera {
  public:
    /// Opens the camera, fixes its settings and starts it. Throws InputError for settings that it cannot
    /// have, RunFault where the device fails.
    V4l2Camera(const std::filesystem::path& node, const CaptureSettings& settings);
    ~V4l2Camera() override;

    /// The newest frame, if it had come by now_ns; times are of CLOCK_MONOTONIC. A loop that is catching up
    /// passes the time of the missed tick as now_ns, and so gets no frame that arrived later. Fails with
    /// Reason::device for good if the camera is gone, refuses, or sends another format than was set; with
    /// Reason::timeout if no whole frame came for 1 s and five frames. While a lost camera is waited for
    /// (CaptureSettings::reconnect_s) there are no frames. One thread at a time.
    Result<std::optional<Frame>> poll(TimeNs now_ns) override;
    FrameCounts counts() const override;

    /// What was set, in words: format, controls as read back, memory; and what the camera could not do.
    const std::vector<std::string>& notes() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace fidservo::vision::v4l2
