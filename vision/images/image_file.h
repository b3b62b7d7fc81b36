#pragma once
// Images as files: 8-bit grey, in and out.

#include "core/result.h"

#include <filesystem>
#include <vector>

#include <opencv2/core/mat.hpp>

namespace fidservo::vision {

/// The image of a file as CV_8UC1: colour becomes luma (ITU-R BT.601), of 16 bits the upper eight are kept,
/// transparency is dropped. Pixels are where the file has them: an orientation tag is not followed.
/// PNG and JPEG; any other format that OpenCV's codecs read. The format is told by the file's first bytes.
/// Fails with Reason::device, naming the file: not there, no image, damaged or cut short, more than
/// most_pixels. Thread-safe.
Result<cv::Mat> read_grey(const std::filesystem::path& file);

/// What is taken for a damaged header rather than for an image.
inline constexpr std::size_t most_pixels = std::size_t{1} << 30;

/// @param grey  CV_8UC1
/// @param compression  1 (fast) to 9 (small)
std::vector<unsigned char> encode_png(const cv::Mat& grey, int compression);

/// @param grey  CV_8UC1
/// @param quality  1 to 100
std::vector<unsigned char> encode_jpeg(const cv::Mat& grey, int quality);

}  // namespace fidservo::vision
