// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Start values for a camera's calibration: a lens and a pose of every view, from the corners alone.
#include "calib/camera/bundle.h"
#include "calib/camera/camera_calibration.h"
#include "calib/camera/target_view.h"
#include "core/camera/camera_geometry.h"
#include "core/result.h"

#include <vector>

namespace fidservo::calib {

/// A lens without coefficients, its principal point in the image's middle.
CameraGeometry plain_lens(const CameraCalibrationOptions& options, double focal_px);

/// Candidate lenses to start from. For plumb_bob: one whose focal length follows from the constraints on
/// homographies, which fails with strong distortion, and one with the focal length and the barrel distortion
/// of the best equidistant lens. For either model: the focal length with the least rough_error_px(), searched
/// in steps of a quarter, starting from that at which the ray to the outermost corner would point straight
/// backwards (the images of a plane by an equidistant lens are no homographies).
std::vector<CameraGeometry> start_lenses(const CameraCalibrationOptions& options,
                                         const std::vector<TargetView>& views);

/// Median distance, px, between the corners and their predicted places with the poses by plane_pose();
/// infinite if a view has no pose.
double rough_error_px(const CameraGeometry& lens, const std::vector<TargetView>& views);

/// The views' poses for a lens. Of the two mirrored poses of a plane, which look alike from afar, the one
/// that explains the view better is taken. Fails with Reason::not_identifiable.
Result<BundleState> start_camera(const CameraGeometry& lens, const std::vector<TargetView>& views,
                                 const Bundle& bundle);

/// Replaces poses by their mirrored twin where that explains the view better with the present lens. Returns
/// whether any was replaced.
bool turn_poses(BundleState& state, const std::vector<TargetView>& views, const Bundle& bundle);

}  // namespace fidservo::calib
