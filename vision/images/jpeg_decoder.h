// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/result.h"

#include <cstddef>
#include <memory>
#include <span>

#include <opencv2/core/mat.hpp>

namespace fidservo::vision {

bool is_jpeg(std::span<const std::byte> bytes);

/// Decodes JPEG to grey: of YCbCr only the luma is decoded; CMYK, which all programs store inverted, is
/// converted to RGB and that to luma. A frame without Huffman tables uses the standard ones, as in motion
/// JPEG. For one thread.
class JpegDecoder {
  public:
    JpegDecoder();
    ~JpegDecoder();
    JpegDecoder(const JpegDecoder&) = delete;
    JpegDecoder& operator=(const JpegDecoder&) = delete;

    /// The image, CV_8UC1. Fails with Reason::device for data that are damaged or truncated, or for a side
    /// beyond most_side_px.
    Result<cv::Mat> decode(std::span<const std::byte> jpeg);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace fidservo::vision
