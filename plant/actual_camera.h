// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The camera as it is, as one geometry: the rig file's with the deviation on top.
#include "core/camera/camera_geometry.h"
#include "plant/camera.h"

namespace fidservo::plant {

/// A camera whose centre need not be above the plate's origin when the stage's position is 0.
struct ActualCamera {
    CameraGeometry geometry;
    Eigen::Vector2d foot_mm = Eigen::Vector2d::Zero();  ///< on the plate, beneath its centre at s = 0

    /// core/camera/camera_geometry.h's project() and back_project() about the foot.
    Eigen::Vector2d image_px(const Eigen::Vector2d& plate_mm, double s_mm) const {
        return project(geometry, plate_mm - foot_mm, s_mm);
    }
    Eigen::Vector2d plate_mm(const Eigen::Vector2d& image_px, double s_mm) const {
        return back_project(geometry, image_px, s_mm) + foot_mm;
    }
};

/// A camera whose centre stands beside where it should by offset_mm, of focal length c f and radial
/// distortion k1 + k; the deviation's rotation and tilt follow the nominal ones: R = R_tilt R_z R_nominal;
/// its centre moves by R_nominal^T R_z^T (e + d - R_tilt^T e). Without a deviation it is the nominal camera,
/// bit for bit.
ActualCamera actual_camera(const CameraGeometry& nominal, const CameraDeviation& deviation);

}  // namespace fidservo::plant
