// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The camera as it is: how it differs from what the rig file says of it.
//
// Geometry. The camera of the rig file (core/camera/camera_geometry.h) sees a plate point at P in its own
// frame: u to the right, v down, z towards the plate. The real one sees it at
//
//     P' = e + R_tilt (R_z P - e - d),   e = (0, 0, Z),     x = P'_x / P'_z,  y = P'_y / P'_z
//
// and pictures that with the focal length c f and the radial coefficient k1 + k in place of f and k1. R_z
// turns from u towards v. R_tilt turns by an angle t about an axis a parallel to the image plane, at h times
// the camera's height over the plate: what the camera looks at then lies aside by
//
//     d = h Z (-a_y sin t, a_x sin t, cos t - 1)
//
// With the axis in the plate, h = 0, it is the same place; at h = 1 the camera's centre stays. c: pixel
// scale. Looking straight down without a nominal distortion, (u, v) = (u0, v0) + c f (x, y) (1 + k (x^2 +
// y^2)). actual_camera.h makes one geometry of both. Source: Hartley, Zisserman, Multiple View Geometry, 2nd
// ed., 2004, ch. 6 and 7.4; Brown, Close-range camera calibration, Photogrammetric Engineering 37(8), 1971.
//
// Time. The camera's clock shows c(t) = rate t. It exposes a frame when its clock shows the frame's nominal
// time, and stamps it with that plus a constant delay. Rows are exposed one after the other, the middle row
// at the frame's time (Liang, Chang, Chen, IEEE Trans. Image Processing 17(8), 2008).
//
// What the program believes of the camera is the rig file; it never sees this.
#include "core/camera/camera_geometry.h"
#include "plant/formulas/formulas.h"

#include <Eigen/Core>

namespace fidservo::plant {

/// All at neutral values: the camera of the rig file.
struct CameraDeviation {
    double pixel_scale = 1.0;                            ///< length in the image per nominal one
    double rotation_rad = 0.0;                           ///< of the picture, from u towards v
    Eigen::Vector2d tilt_rad = Eigen::Vector2d::Zero();  ///< rotation vector's parts along u and v
    double tilt_axis_height = 0.0;                       ///< h
    double distortion = 0.0;                             ///< k
    double delay_s = 0.0;                                ///< of stamp and arrival
    double clock_rate = 1.0;                             ///< camera seconds per second
    double readout_s = 0.0;                              ///< from the first row's exposure to the last one's
    double extra_exposure_s = 0.0;                       ///< beyond the rig file's
    double extra_blur_px = 0.0;                          ///< standard deviation, added in squares
    double extra_read_noise_e = 0.0;                     ///< r.m.s., added in squares
    double gain_spread = 0.0;                            ///< standard deviation of the pixels' gains
    Eigen::Vector2d light_gradient = Eigen::Vector2d::Zero();  ///< added to the light's, view_options.h
    double vignetting = 0.0;                                   ///< likewise
    Eigen::Vector2d offset_mm = Eigen::Vector2d::Zero();       ///< of the camera's centre along the plate
    Formulas formulas{};  ///< at the ports of camera and plate; not contained in the numbers above
};

/// The camera at a moment: with what its formulas add to its geometry there.
/// @param s_mm  where on the plate the camera should be: carriage and platform
CameraDeviation deviation_at(const CameraDeviation& deviation, double time_s, double s_mm);

/// Whether its geometry changes with time or place.
bool geometry_changes(const CameraDeviation& deviation);

/// With how much delay a frame is stamped, s.
double stamp_delay_s(const CameraDeviation& deviation, double time_s);

/// When a frame of a stamp was exposed, by the stage's clock, s.
double exposed_s(const CameraDeviation& deviation, double stamp_s);

/// Where a tag lies on the plate beside where it should, mm.
Eigen::Vector2d tag_offset_mm(const CameraDeviation& deviation, const Eigen::Vector2d& tag_mm);

/// When the row of an image point is exposed, after the frame's time, s.
double row_delay_s(const CameraGeometry& camera, const CameraDeviation& deviation, double v_px);

}  // namespace fidservo::plant
