// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What other views of the same target would tell of a camera's focal length.
#include "calib/camera/camera_calibration.h"

#include <optional>

namespace fidservo::calib {

/// The standard error of the focal length, px, if in every view the target were turned by so much more about
/// an axis in its plane through the middle of what is seen, to four sides in turn: from the Jacobian at the
/// corners that the lens found would show, as far as they are in the image, with the covariances of the
/// corners seen. Empty if that would show less than half of the tags, or determines no lens.
std::optional<double> focal_std_if_tilted_px(const CameraCalibration& calibration, double more_tilt_rad);

}  // namespace fidservo::calib
