// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The settings that a camera is to have.
#include "vision/v4l2/pixel_format.h"

#include <optional>

namespace fidservo::vision::v4l2 {

/// Who allocates the frames' memory.
enum class Memory {
    mapped,  ///< the driver does; the program maps it
    user,    ///< the program does; the driver fills it
};

/// The settings that a camera is to have.
struct CaptureSettings {
    int width_px = 0;            ///< of the image
    int height_px = 0;           ///< of the image
    double frame_rate_hz = 0.0;  ///< frames a second
    double exposure_s = 0.0;     ///< time that a pixel gathers light
    /// From the middle of the exposure to the arrival, for frames without a time stamp.
    double latency_s = 0.0;
    std::optional<PixelFormat> pixels;  ///< empty: the first of the preferred ones that the camera offers
    std::optional<int> gain;            ///< in the driver's units; empty: unchanged, but not automatic
    std::optional<int> focus;           ///< in the driver's units; empty: unchanged, but not automatic
    Memory memory = Memory::mapped;     ///< the other kind is used where the driver lacks it
    double reconnect_s = 0.0;           ///< how long to wait for a camera that is lost
};

}  // namespace fidservo::vision::v4l2
