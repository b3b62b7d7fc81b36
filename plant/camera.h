// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The camera as it really is: how it deviates from what the rig file says.
//
// Geometry. The camera of the rig file (core/camera/camera_geometry.h) sees a plate point at P in its own
// frame: u to the right, v down, z towards the plate. The real camera sees it at
//
//     P' = e + R_tilt (R_z P - e - d),   e = (0, 0, Z),     x = P'_x / P'_z,  y = P'_y / P'_z
//
// and pictures that with the focal length c f, c the pixel scale, and the radial coefficient k1 + k in place
// of f and k1. R_z turns from u towards v. R_tilt turns by an angle t about an axis a that is parallel to the
// image plane, at h times the camera's height over the plate. The point that the camera looks at is then
// displaced by
//
//     d = h Z (-a_y sin t, a_x sin t, cos t - 1)
//
// With the axis in the plate, h = 0, it is not displaced; at h = 1 the camera's centre stays. Looking
// straight down without a nominal distortion, (u, v) = (u0, v0) + c f (x, y) (1 + k (x^2 + y^2)).
// actual_camera.h combines nominal and real camera into one geometry. Source: Hartley, Zisserman, Multiple
// View Geometry, 2nd ed., 2004, ch. 6 and 7.4; Brown, Close-range camera calibration, Photogrammetric
// Engineering 37(8), 1971.
//
// Time. The camera's clock shows c(t) = rate t. It exposes a frame when its clock shows the frame's nominal
// time, and stamps it with that plus a constant delay. Rows are exposed one after the other, the middle row
// at the frame's time (Liang, Chang, Chen, IEEE Trans. Image Processing 17(8), 2008).
//
// The program's own model of the camera is the rig file; it never sees this one.
#include "core/camera/camera_geometry.h"
#include "plant/formulas/formulas.h"

#include <Eigen/Core>

namespace fidservo::plant {

/// Deviation of the real camera. The defaults are neutral: the camera of the rig file.
struct CameraDeviation {
    double pixel_scale = 1.0;                            ///< c: length in the image per nominal length
    double rotation_rad = 0.0;                           ///< rotation of the image, from u towards v
    Eigen::Vector2d tilt_rad = Eigen::Vector2d::Zero();  ///< rotation vector's parts along u and v
    double tilt_axis_height = 0.0;  ///< h: height of the tilt's axis over the plate, relative to the camera's
    double distortion = 0.0;        ///< k: added to the radial coefficient k1
    double delay_s = 0.0;           ///< delay of the time stamp and of the frame's arrival
    double clock_rate = 1.0;        ///< camera seconds per second
    double readout_s = 0.0;         ///< time from the first row's exposure to the last one's
    double extra_exposure_s = 0.0;  ///< added to the rig file's exposure time
    double extra_blur_px = 0.0;     ///< standard deviation, added to the blur's in quadrature
    double extra_read_noise_e = 0.0;  ///< r.m.s., added to the read noise in quadrature
    double gain_spread = 0.0;         ///< standard deviation of the pixels' gains
    /// Added to the light's gradient (view_options.h).
    Eigen::Vector2d light_gradient = Eigen::Vector2d::Zero();
    double vignetting = 0.0;  ///< added to the light's vignetting
    /// Displacement of the camera's centre along the plate.
    Eigen::Vector2d offset_mm = Eigen::Vector2d::Zero();
    Formulas formulas{};  ///< formulas at the ports of camera and plate, which add to the numbers above
};

/// The deviation at a time and place: with what its formulas add to the geometry there.
/// @param s_mm  nominal camera position on the plate, carriage plus platform
CameraDeviation deviation_at(const CameraDeviation& deviation, double time_s, double s_mm);

/// Whether the camera's geometry changes with time or place.
bool geometry_changes(const CameraDeviation& deviation);

/// Delay of a frame's time stamp, s.
double stamp_delay_s(const CameraDeviation& deviation, double time_s);

/// When a frame with a time stamp was exposed, by the stage's clock, s.
double exposed_s(const CameraDeviation& deviation, double stamp_s);

/// Displacement of a tag on the plate from its nominal place, mm.
Eigen::Vector2d tag_offset_mm(const CameraDeviation& deviation, const Eigen::Vector2d& tag_mm);

/// Time from the frame's time to the exposure of the row of an image point, s.
double row_delay_s(const CameraGeometry& camera, const CameraDeviation& deviation, double v_px);

}  // namespace fidservo::plant
