// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The camera as it really is, as a single geometry: the rig file's with the deviation added.
#include "core/camera/camera_geometry.h"
#include "plant/camera.h"

namespace fidservo::plant {

/// A camera whose centre is above the plate point foot_mm when the stage's position is 0.
struct ActualCamera {
    CameraGeometry geometry;
    /// The plate point beneath the camera's centre at s = 0.
    Eigen::Vector2d foot_mm = Eigen::Vector2d::Zero();

    /// project() and back_project() of core/camera/camera_geometry.h, with plate points taken relative to the
    /// foot.
    Eigen::Vector2d image_px(const Eigen::Vector2d& plate_mm, double s_mm) const {
        return project(geometry, plate_mm - foot_mm, s_mm);
    }
    Eigen::Vector2d plate_mm(const Eigen::Vector2d& image_px, double s_mm) const {
        return back_project(geometry, image_px, s_mm) + foot_mm;
    }
};

/// The camera of focal length c f and radial distortion k1 + k, with its centre offset_mm from its nominal
/// place; rotation and tilt of the deviation are applied after the nominal ones: R = R_tilt R_z R_nominal;
/// its centre moves by R_nominal^T R_z^T (e + d - R_tilt^T e). Without a deviation the nominal camera
/// results, bit for bit.
ActualCamera actual_camera(const CameraGeometry& nominal, const CameraDeviation& deviation);

}  // namespace fidservo::plant
