// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Whether what comes from the camera can be an image of the plate, taken now.
#include "control/stage.h"
#include "core/result.h"
#include "vision/camera.h"

#include <optional>
#include <string>
#include <vector>

namespace fidservo {

struct CameraWatchParams {
    double frame_period_s;
    /// Nothing comes, or nothing usable: borne so long, and at least five frames.
    double patience_s = 1.0;
    double reconnect_s = 0.0;  ///< a camera that may come back is silent for so long
    double count_mm = 0.05;    ///< of the encoder
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

    /// What the camera gave at a poll, unless its time cannot be believed. Fails with Reason::device.
    Result<std::optional<vision::Frame>> admit(std::optional<vision::Frame> frame,
                                               const control::StageSample& stage);

    /// Whether something was wrong with the last frame.
    bool is_in_doubt() const { return trouble_.has_value(); }

  private:
    struct Trouble {
        TimeNs since_ns;
        int frames;
    };
    /// An image, where the stage was when it first came, and when it was seen to have moved away.
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
