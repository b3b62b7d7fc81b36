#pragma once

#include "core/result.h"

#include <cstddef>
#include <span>

#include <opencv2/core/mat.hpp>

namespace fidservo::vision {

bool is_png(std::span<const std::byte> bytes);

/// A PNG as CV_8UC1, as read_grey() says. Fails with Reason::device for data that are damaged anywhere or cut
/// short, or of more than most_pixels.
Result<cv::Mat> decode_png(std::span<const std::byte> png);

}  // namespace fidservo::vision
