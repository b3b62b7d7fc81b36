// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a camera is asked for.
#include "vision/v4l2/pixel_format.h"

#include <optional>

namespace fidservo::vision::v4l2 {

/// Who allocates the frames' memory.
enum class Memory {
    mapped,  ///< the driver; the program maps it
    user,    ///< the program; the driver fills it
};

/// How a camera is to be set.
struct CaptureSettings {
    int width_px = 0;                   ///< of the image
    int height_px = 0;                  ///< of the image
    double frame_rate_hz = 0.0;         ///< frames a second
    double exposure_s = 0.0;            ///< time that a pixel gathers light
    double latency_s = 0.0;             ///< FrameDelays: for frames without a time stamp
    std::optional<PixelFormat> pixels;  ///< empty: the first of the preferred ones that the camera offers
    std::optional<int> gain;            ///< in the driver's units; empty: stays as it is, not automatic
    std::optional<int> focus;           ///< likewise
    Memory memory = Memory::mapped;     ///< the other one where the driver lacks it
    double reconnect_s = 0.0;           ///< a camera that is lost is waited for so long
};

}  // namespace fidservo::vision::v4l2
