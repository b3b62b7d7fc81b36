// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Videos for tests, written with FFmpeg's libraries.
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

namespace fidservo::testing {

struct Film {
    /// ffv1, mjpeg, mpeg4 or libx264; mpeg4 and libx264 predict frames from other frames.
    std::string codec = "ffv1";
    std::string container = {};  ///< empty: by the file's ending
    /// CV_8UC1, all of one size; for ffv1 also CV_16UC1. The luma of mpeg4 and libx264 has limited range.
    std::vector<cv::Mat> frames;
    std::vector<std::int64_t> times;  ///< in units of `unit_ms`, one for each frame
    int unit_ms = 1;
    bool is_turned = false;  ///< with a display matrix of a quarter turn
};

/// Throws std::runtime_error if it cannot be written.
void write_film(const std::filesystem::path& file, const Film& film);

}  // namespace fidservo::testing
