// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Pictures of a calibration in the image plane, as plain SVG.
#include "calib/camera/calibration_verdict.h"
#include "calib/camera/camera_calibration.h"

#include <string>

namespace fidservo {

/// Every corner that was seen, over the cells of the image; cells without any are marked.
std::string coverage_svg(const calib::CameraCalibration& calibration, const calib::Coverage& coverage);

/// Mean residual in each cell of the image as an arrow, magnified: what a lens model leaves shows as a
/// pattern.
std::string residual_field_svg(const calib::CameraCalibration& calibration);

}  // namespace fidservo
