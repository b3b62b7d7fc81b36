// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The corners that a refinement without a calibrated camera reports for a tag seen through a distorting lens.
//
// Such a refinement fits a perspective picture of the tag to the image, by least squares along all edges of
// its code. A lens bends those edges, so that the corners of the best perspective picture are not the imaged
// corners. With the tag's own coordinates p in [-1, 1]^2 and the lens' shift d(p) in px, in the tag's
// directions, the corners found are, to first order in the shift,
//
//     c_k + B(p_k) argmin_h sum_i w_i |B(p_i) h - d(p_i)|^2
//
// with c_k the image of corner k by the pinhole camera, and B the eight directions in which a perspective
// picture can change: 1, x, y for each coordinate, (x x, x y), (x y, y y). Source of B: Hartley, Zisserman,
// Multiple View Geometry, 2nd ed., 2004, ch. 2.4.
#include "core/camera/camera_geometry.h"
#include "core/plate.h"

#include <array>

#include <Eigen/Core>

namespace fidservo::calib {

/// The corners in px, in the order of detections, that are reported for a tag seen from camera position s.
/// Without distortion they are the projected corners.
std::array<Eigen::Vector2d, 4> pictured_corners(const CameraGeometry& camera, const PlateTag& tag,
                                                double s_mm);

}  // namespace fidservo::calib
