// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The benefit that other views of the same target would have for a camera's focal length.
#include "calib/camera/camera_calibration.h"

#include <optional>

namespace fidservo::calib {

/// The standard error of the focal length, px, if the target were tilted by `more_tilt_rad` more in every
/// view, to four sides in turn, about an axis in its plane through the middle of its visible part. It follows
/// from the Jacobian at the corners that would then be in the image, with the covariances of the corners
/// measured. Empty if less than half of the tags would be in the image, or if the lens would not be
/// determined.
std::optional<double> focal_std_if_tilted_px(const CameraCalibration& calibration, double more_tilt_rad);

}  // namespace fidservo::calib
