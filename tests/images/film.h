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
    /// ffv1, mjpeg, mpeg4, libtheora or libx264; the last three predict frames from other frames.
    std::string codec = "ffv1";
    std::string container = {};  ///< empty: by the file's ending
    /// CV_8UC1, all of one size; for ffv1 also CV_16UC1. The luma of those three has limited range.
    std::vector<cv::Mat> frames;
    std::vector<std::int64_t> times;  ///< in units of `unit_ms`, one for each frame
    int unit_ms = 1;
    bool is_turned = false;                 ///< with a display matrix of a quarter turn
    int frames_between = 0;                 ///< frames of mpeg4 that are predicted from a later one, too
    int pixel_width = 1, pixel_height = 1;  ///< stated proportions of a pixel
};

/// Throws std::runtime_error if it cannot be written.
void write_film(const std::filesystem::path& file, const Film& film);

}  // namespace fidservo::testing
