// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The result of a camera's calibration as lines of text and as an HTML report.
#include "calib/camera/calibration_verdict.h"
#include "calib/camera/camera_calibration.h"
#include "calib/camera/photon_transfer.h"

#include <optional>
#include <string>
#include <vector>

namespace fidservo {

struct CameraAnswer {
    std::string target;
    std::string source;  ///< where the images come from
    std::size_t images = 0, without_target = 0;
    calib::CameraCalibration calibration;
    calib::Coverage coverage;
    std::vector<std::string> shortcomings;
    std::vector<std::string> notes;  ///< for a good calibration: what would explain the corners better still
    std::optional<calib::PhotonTransfer> noise;
    std::string no_noise;  ///< why the noise could not be measured, where that was asked for
};

/// The values with their standard errors and the verdict.
std::string describe(const CameraAnswer& answer);

/// The report: values, where in the image the target was seen, residuals, views, noise. One HTML file.
std::string camera_report(const CameraAnswer& answer);

}  // namespace fidservo
