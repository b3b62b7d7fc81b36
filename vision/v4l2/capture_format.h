// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The format in which a camera sends its frames.
#include "vision/v4l2/capture_settings.h"
#include "vision/v4l2/device.h"
#include "vision/v4l2/pixel_format.h"

#include <cstddef>
#include <string>

namespace fidservo::vision::v4l2 {

struct CaptureFormat {
    PixelFormat pixels = PixelFormat::grey;
    int width_px = 0;
    int height_px = 0;
    std::size_t bytes_per_line = 0;  ///< 0 for compressed formats
    std::size_t frame_bytes = 0;     ///< largest size of a frame
};

/// The format in words, "640 x 480 px GREY".
std::string text_of(const CaptureFormat& format);

/// Sets pixel format, size and frame rate, and reads them back. Throws InputError for a format or a size that
/// the camera does not have, naming the key in the rig file's camera section and what is allowed; RunFault if
/// the camera refuses.
CaptureFormat set_format(const Device& device, const CaptureSettings& settings);

/// The frame rate in force, Hz; 0 if the driver does not state it.
double frame_rate_hz(const Device& device);

/// The format that is in force now, e.g. "320 x 240 px YUYV": it may have changed since it was set.
std::string format_in_force(const Device& device);

}  // namespace fidservo::vision::v4l2
