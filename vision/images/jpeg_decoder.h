// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/result.h"

#include <cstddef>
#include <memory>
#include <span>

#include <opencv2/core/mat.hpp>

namespace fidservo::vision {

bool is_jpeg(std::span<const std::byte> bytes);

/// JPEG to grey: of YCbCr the luma alone is decoded; those for print (CMYK, inverted as all programs write
/// it) become the luma of their red, green and blue. A frame without Huffman tables has the standard's, as in
/// motion-JPEG. Single-threaded.
class JpegDecoder {
  public:
    JpegDecoder();
    ~JpegDecoder();
    JpegDecoder(const JpegDecoder&) = delete;
    JpegDecoder& operator=(const JpegDecoder&) = delete;

    /// The image, CV_8UC1. Fails with Reason::device for data that are damaged anywhere or cut short, or of
    /// a side beyond most_side_px.
    Result<cv::Mat> decode(std::span<const std::byte> jpeg);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace fidservo::vision
