// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The images from which a camera is calibrated.
#include "calib/camera/target_images.h"
#include "src/calibrate/camera_target.h"

#include <filesystem>
#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

namespace fidservo {

struct CalibrationImages {
    /// Images that show the target, each with a pose unlike the one before.
    std::vector<calib::TargetImage> views;
    std::vector<std::vector<cv::Mat>> bursts;  ///< bursts of frames at rest among the images
    std::size_t images = 0;
    std::size_t without_target = 0;
    int width_px = 0, height_px = 0;
    std::vector<std::string> notes{};  ///< what was skipped or left out, one line each
};

/// Finds the target in all images of folders, recordings and videos; those that are damaged or missing are
/// left out. All images use the same range of grey levels. Throws InputError: an input that cannot be read,
/// images of different sizes, tags that the target does not have (a wrong grid), no tag at all.
CalibrationImages read_calibration_images(const std::vector<std::filesystem::path>& inputs,
                                          const CameraTarget& target);

/// All images of a folder as one burst; each has to be readable. Throws InputError.
std::vector<cv::Mat> read_burst(const std::filesystem::path& folder);

}  // namespace fidservo
