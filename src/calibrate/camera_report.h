// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a camera's calibration found, for people: a page and lines of text.
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
    std::vector<std::string> notes;  ///< where it is good: what would explain the corners better still
    std::optional<calib::PhotonTransfer> noise;
    std::string no_noise;  ///< why there is none, where it was asked for
};

/// The values with their standard errors and the verdict.
std::string describe(const CameraAnswer& answer);

/// The report: values, where in the image the target was seen, residuals, views, noise. One HTML file.
std::string camera_report(const CameraAnswer& answer);

}  // namespace fidservo
