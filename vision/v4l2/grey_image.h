// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Converts a frame's bytes to a grey image.
#include "core/result.h"
#include "vision/images/jpeg_decoder.h"
#include "vision/v4l2/capture_format.h"

#include <cstddef>
#include <span>

#include <opencv2/core/mat.hpp>

namespace fidservo::vision::v4l2 {

/// Whether a whole frame was filled; always true for compressed formats.
/// @param used  bytes that the driver filled
bool is_whole(const CaptureFormat& format, std::size_t used);

/// The frame as 8-bit grey, linear in the camera's values: GREY unchanged, Y16/Y12/Y10 scaled so that full
/// scale is 255 and rounded, YUYV and MJPEG their luma. GREY returns a view of the bytes, the others a new
/// image. A JPEG has the size that it states, which may differ from the format's; one that is damaged fails
/// with Reason::device.
Result<cv::Mat> grey_image(const CaptureFormat& format, std::span<const std::byte> bytes, JpegDecoder& jpeg);

}  // namespace fidservo::vision::v4l2
