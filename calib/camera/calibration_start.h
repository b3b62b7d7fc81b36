// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Where a camera's calibration begins: a lens and a pose of every view from nothing but corners.
#include "calib/camera/bundle.h"
#include "calib/camera/camera_calibration.h"
#include "calib/camera/target_view.h"
#include "core/camera/camera_geometry.h"
#include "core/result.h"

#include <vector>

namespace fidservo::calib {

/// A lens without coefficients, its principal point in the image's middle.
CameraGeometry plain_lens(const CameraCalibrationOptions& options, double focal_px);

/// Plain lenses to begin with. Of a plumb_bob lens one whose focal length is from the constraints that
/// homographies have, which distortion can spoil, and one with the focal length and the barrel distortion of
/// the best equidistant lens. Of either model, the best of focal lengths in steps of a quarter by
/// rough_error_px(), from the one by which the outermost corner is seen in the direction straight behind: an
/// equidistant lens's pictures of a plane are no homographies.
std::vector<CameraGeometry> start_lenses(const CameraCalibrationOptions& options,
                                         const std::vector<TargetView>& views);

/// Median distance, px, of corners from where each view's pose by plane_pose() puts them: infinite if a view
/// has none.
double rough_error_px(const CameraGeometry& lens, const std::vector<TargetView>& views);

/// The poses by a lens, each the better of the two that look alike from afar. Fails with
/// Reason::not_identifiable.
Result<BundleState> start_camera(const CameraGeometry& lens, const std::vector<TargetView>& views,
                                 const Bundle& bundle);

/// Exchanges the poses that by the lens as it is now explain their view better the other way round. Says
/// whether any was.
bool turn_poses(BundleState& state, const std::vector<TargetView>& views, const Bundle& bundle);

}  // namespace fidservo::calib
