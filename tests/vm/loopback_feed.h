// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The output side of v4l2loopback: images shown here are those that a camera on the node sees.
#include "vision/v4l2/device.h"
#include "vision/v4l2/pixel_format.h"

#include <cstdint>
#include <filesystem>
#include <vector>

#include <opencv2/core/mat.hpp>

namespace fidservo::devices {

/// Grey levels in a pixel format: YUYV without colour, Y16 with 65535 for 255, JPEG of the best quality.
std::vector<std::uint8_t> encoded(const cv::Mat& grey, vision::v4l2::PixelFormat pixels);

class LoopbackFeed {
  public:
    /// Sets the format and shows a black frame: before the first one, the node offers no format to cameras.
    /// Throws std::runtime_error.
    LoopbackFeed(const std::filesystem::path& node, vision::v4l2::PixelFormat pixels, cv::Size size_px);

    void show(const cv::Mat& grey);

  private:
    vision::v4l2::Device device_;
    vision::v4l2::PixelFormat pixels_;
};

}  // namespace fidservo::devices
