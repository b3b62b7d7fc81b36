// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Where a plate point appears in the image, and back.
//
// Frames. Plate: x along the row of fiducials, positive to the right, y positive down in the image, z from
// the camera towards the plate, mm. Camera position s = macro + micro, mm: the plate x of the foot of the
// perpendicular from the camera's centre to the plate. Image: u right, v down, px; pixel centres lie at
// integer coordinates. A point P of the plate is seen from position s at
//
//     Q = R_tilt R_z (P - s a + (0, 0, Z))
//     (x', y'): the lens's picture of the direction Q, by one of the models of core/camera/lens.h
//     u = u0 + f x',   v = v0 + f q y'
//
// R_z turns from u towards v, R_tilt about an axis in the image plane, a: the stage's axis, a unit vector.
// A camera that looks straight down along a true axis through a pinhole: u = u0 + f (X - s) / Z, v = v0 + f
// Y / Z.
#include "core/camera/lens.h"

#include <Eigen/Core>

namespace fidservo {

/// A camera over the plate, as the top of core/camera/camera_geometry.h describes it.
struct CameraGeometry {
    int width_px;                        ///< of the image
    int height_px;                       ///< of the image
    double focal_px;                     ///< f: focal length over a pixel's width
    Eigen::Vector2d principal_point_px;  ///< (u0, v0)
    double distance_mm;                  ///< Z: from the camera's centre to the plate
    double focal_ratio = 1.0;            ///< q = f_y / f_x: a square's height over its width in the image
    LensDistortion distortion = {};      ///< of the lens
    double rotation_rad = 0.0;           ///< of R_z, from u towards v
    Eigen::Vector2d tilt_rad = Eigen::Vector2d::Zero();  ///< rotation vector's parts along u and v
    /// The stage's axis a = (1, axis_rad.x, axis_rad.y) / |.| in the plate's frame.
    Eigen::Vector2d axis_rad = Eigen::Vector2d::Zero();
};

/// Length on the plate of a pixel at the optical axis. Exact for a camera that looks straight down, to second
/// order in the tilt for another one.
inline double mm_per_px(const CameraGeometry& camera) {
    return camera.distance_mm / camera.focal_px;
}

/// Whether the camera is a pinhole that looks straight down: no rotation, tilt, distortion, unequal focal
/// lengths or oblique axis.
bool looks_straight(const CameraGeometry& camera);

/// R_tilt R_z: from the plate's frame to the camera's.
Eigen::Matrix3d camera_from_plate(const CameraGeometry& camera);

/// Image point in px of a plate point in mm, seen from camera position s. NaN beyond the domain of an
/// equidistant lens.
Eigen::Vector2d project(const CameraGeometry& camera, const Eigen::Vector2d& plate_mm, double s_mm);

/// Plate point in mm of an image point in px, seen from camera position s. NaN where the image shows nothing
/// of the plate: the lens images no ray there, or the ray leads away from the plate.
Eigen::Vector2d back_project(const CameraGeometry& camera, const Eigen::Vector2d& image_px, double s_mm);

}  // namespace fidservo
