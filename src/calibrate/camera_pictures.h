// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Plots of a calibration over the image plane, as plain SVG.
#include "calib/camera/calibration_verdict.h"
#include "calib/camera/camera_calibration.h"

#include <string>

namespace fidservo {

/// Every measured corner, over the cells of the image; cells without corners are marked.
std::string coverage_svg(const calib::CameraCalibration& calibration, const calib::Coverage& coverage);

/// Mean residual in each cell of the image as a magnified arrow: systematic errors of a lens model show as a
/// pattern.
std::string residual_field_svg(const calib::CameraCalibration& calibration);

}  // namespace fidservo
