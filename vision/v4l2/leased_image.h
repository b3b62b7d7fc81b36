// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "vision/v4l2/buffer_queue.h"

#include <opencv2/core/mat.hpp>

namespace fidservo::vision::v4l2 {

/// An image in a leased buffer: the lease ends with the last cv::Mat that shares the image.
/// @param view  an image over the lease's bytes
cv::Mat leased_image(Lease lease, const cv::Mat& view);

}  // namespace fidservo::vision::v4l2
