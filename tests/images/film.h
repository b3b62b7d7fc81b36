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
    std::string codec = "ffv1";  ///< ffv1, mjpeg, mpeg4 or libx264, of which frames build on later ones
    std::string container = {};  ///< by the file's ending, if empty
    /// CV_8UC1, all of one size; for ffv1 CV_16UC1, too. The luma of mpeg4 and libx264 has television's
    /// range.
    std::vector<cv::Mat> frames;
    std::vector<std::int64_t> times;  ///< in units of `unit_ms`, one a frame
    int unit_ms = 1;
    bool is_turned = false;  ///< has a display matrix of a quarter turn
};

/// Throws std::runtime_error if it cannot be written.
void write_film(const std::filesystem::path& file, const Film& film);

}  // namespace fidservo::testing
