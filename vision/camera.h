// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The boundary to a camera, real (V4L2) or simulated.
#include "core/result.h"
#include "core/time.h"

#include <cstdint>
#include <optional>
#include <string>

#include <opencv2/core/mat.hpp>

namespace fidservo::vision {

/// An image and when it was taken.
struct Frame {
    cv::Mat image;               ///< CV_8UC1
    TimeNs time_ns = 0;          ///< middle of the exposure
    TimeNs arrival_ns = 0;       ///< when the program could first have the frame
    std::uint64_t sequence = 0;  ///< the camera's own number of the frame
    std::string source;          ///< file name, of an image that was read from disk
};

/// What became of the frames that a camera took.
struct FrameCounts {
    std::uint64_t handed_out = 0;  ///< frames that the program asked for and got
    std::uint64_t skipped = 0;     ///< frames that were replaced by a newer one before the program asked
    std::uint64_t lost = 0;        ///< frames that the camera took and never delivered: gaps in its numbers
    std::uint64_t damaged = 0;     ///< frames delivered with an error, truncated or not decodable
    /// Frames without a usable time stamp: their time is the arrival's less the latency.
    std::uint64_t unstamped = 0;
    std::uint64_t reconnects = 0;  ///< times that the camera was lost and came back

    bool operator==(const FrameCounts&) const = default;
    /// Adds the counts of another camera or another time.
    FrameCounts& operator+=(const FrameCounts& more) {
        handed_out += more.handed_out;
        skipped += more.skipped;
        lost += more.lost;
        damaged += more.damaged;
        unstamped += more.unstamped;
        reconnects += more.reconnects;
        return *this;
    }
};

/// A camera that takes images by itself and hands out the newest one.
class Camera {
  public:
    Camera() = default;
    Camera(const Camera&) = delete;
    Camera& operator=(const Camera&) = delete;
    virtual ~Camera() = default;

    /// The newest frame that has arrived by now_ns and was not handed out before; empty if there is none.
    /// Fails with Reason::device.
    virtual Result<std::optional<Frame>> poll(TimeNs now_ns) = 0;

    /// The counts so far. Cameras that cannot lose frames count nothing.
    virtual FrameCounts counts() const { return {}; }
};

}  // namespace fidservo::vision
