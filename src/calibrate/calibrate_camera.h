// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The implementation of the command `calibrate camera`.
#include "calib/camera/calibration_verdict.h"
#include "src/calibrate/camera_target.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace fidservo {

struct CalibrateCameraOptions {
    std::vector<std::filesystem::path> inputs;
    std::filesystem::path rig_file;
    std::filesystem::path target_file;
    std::string grid;
    double tag_size_mm = 0.0;
    double tag_spacing = 0.0;
    std::string lens = "plumb_bob";
    bool focal_ratio = false;
    calib::CalibrationLimits limits;
    std::filesystem::path noise_frames;
    std::filesystem::path camera_info;
    std::filesystem::path write_rig;
    std::filesystem::path report;
};

/// Calibrates, prints the result and returns the exit code. Only a good calibration is written to a rig file
/// or a ROS file; the report is written whatever the verdict. Throws InputError, RunFault if the disk fails.
int calibrate_camera(const CalibrateCameraOptions& options);

}  // namespace fidservo
