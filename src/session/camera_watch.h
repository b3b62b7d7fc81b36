// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Checks whether the camera's frames are plausible: images of the plate, taken now.
#include "control/stage.h"
#include "core/result.h"
#include "vision/camera.h"

#include <optional>
#include <string>
#include <vector>

namespace fidservo {

struct CameraWatchParams {
    double frame_period_s;
    /// How long missing or unusable frames are tolerated; in any case for five frames.
    double patience_s = 1.0;
    double reconnect_s = 0.0;  ///< how long a camera that may come back can be silent
    double count_mm = 0.05;    ///< resolution of the encoder
};

/// Looks at every frame that the program takes. What is wrong for longer than the patience is a fault of the
/// device, with its reason:
///   no frame; a time stamp 0.1 s ahead of the stage's clock, or a second behind; a black or a
///   saturated image; the same image, pixel for pixel, although the stage has moved since.
/// The last is known from a sample of the pixels, by frames that were exposed after the motion was noticed:
/// a camera without noise at rest is no fault.
class CameraWatch {
  public:
    explicit CameraWatch(const CameraWatchParams& params) : params_(params) {}

    /// Passes on what the camera returned at a poll, unless its time is implausible. Fails with
    /// Reason::device.
    Result<std::optional<vision::Frame>> admit(std::optional<vision::Frame> frame,
                                               const control::StageSample& stage);

    /// Whether something is wrong with the last frame, but not yet for long enough to be a fault.
    bool is_in_doubt() const { return trouble_.has_value(); }

  private:
    struct Trouble {
        TimeNs since_ns;
        int frames;
    };
    /// An image, the stage's position when it first came, and the time when the stage was seen to have moved
    /// away.
    struct Seen {
        std::vector<unsigned char> pixels;
        control::StageSample stage;
        std::optional<TimeNs> moved_ns;
    };

    Status silent(TimeNs now_ns);
    bool is_frozen(const vision::Frame& frame, const std::vector<unsigned char>& pixels,
                   const control::StageSample& stage);

    CameraWatchParams params_;
    double silent_s_ = 0.0;
    std::optional<TimeNs> last_poll_ns_;
    std::optional<Trouble> trouble_;
    std::optional<Seen> seen_;
};

}  // namespace fidservo
