// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A frame's bytes as a grey image.
#include "core/result.h"
#include "vision/images/jpeg_decoder.h"
#include "vision/v4l2/capture_format.h"

#include <cstddef>
#include <span>

#include <opencv2/core/mat.hpp>

namespace fidservo::vision::v4l2 {

/// Is this what a whole frame has? Compressed frames: anything. @param used  bytes that the driver filled
bool is_whole(const CaptureFormat& format, std::size_t used);

/// 8-bit grey, linear in what the sensor gave: GREY as it is, Y16/Y12/Y10 scaled so that full scale is 255
/// and rounded, YUYV its luma as it is, MJPEG its luma. GREY gives a view on the bytes; the others a new
/// image. A JPEG has the size that it says, which may be another than the format's; one that is damaged fails
/// with Reason::device.
Result<cv::Mat> grey_image(const CaptureFormat& format, std::span<const std::byte> bytes, JpegDecoder& jpeg);

}  // namespace fidservo::vision::v4l2
