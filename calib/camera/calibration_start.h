#pragma once
// Where a camera's calibration begins: a lens and a pose of every view from nothing but corners.
#include "calib/camera/bundle.h"
#include "calib/camera/camera_calibration.h"
#include "calib/camera/target_view.h"
#include "core/camera_geometry.h"
#include "core/result.h"

#include <vector>

namespace fidservo::calib {

/// A lens without coefficients, its principal point in the image's middle.
CameraGeometry plain_lens(const CameraCalibrationOptions& options, double focal_px);

/// A plain lens of such a focal length that the views' own poses explain the corners well. plumb_bob: by the
/// constraints that homographies have; equidistant, whose pictures of a plane are not homographies: the best
/// of focal lengths in steps of a tenth, from the one by which the outermost corner is seen in the direction
/// straight behind.
CameraGeometry start_lens(const CameraCalibrationOptions& options, const std::vector<TargetView>& views);

/// Median distance, px, of corners from where each view's pose by plane_pose() puts them: infinite if a view
/// has none.
double rough_error_px(const CameraGeometry& lens, const std::vector<TargetView>& views);

/// The poses by a lens, each the better of the two that look alike from afar. Fails with
/// Reason::not_identifiable.
Result<BundleState> start_camera(const CameraGeometry& lens, const std::vector<TargetView>& views,
                                 const Bundle& bundle);

}  // namespace fidservo::calib
