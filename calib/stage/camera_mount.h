// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How a calibrated camera is mounted over the plate: rotation, tilt and distance.
#include "calib/camera/target_view.h"
#include "core/camera/camera_geometry.h"
#include "core/result.h"

#include <vector>

#include <Eigen/Core>

namespace fidservo::calib {

/// The fitted camera position of one view.
struct MountView {
    double s_mm;  ///< camera position along the stage's axis, in the frame of the printed tags
    double s_std_mm;
    double y_mm;  ///< plate y of the camera's position
    double y_std_mm;
    double rms_px;  ///< r.m.s. distance of the corners from their predicted places
};

struct CameraMount {
    CameraGeometry camera;       ///< the lens given, with rotation_rad, tilt_rad and distance_mm fitted
    Eigen::Matrix4d covariance;  ///< of (rotation_rad, tilt_rad.x, tilt_rad.y, distance_mm)
    std::vector<MountView> views;
    double rms_px;
    double misfit;  ///< chi^2 of the residuals per degree of freedom; 1: noise alone
};

/// Rotation, tilt and distance of a camera whose lens is known, from views of tags whose relative places are
/// known: weighted least squares of all measured directions of the tags' corners over (rotation, tilt, Z)
/// common to all views and the camera's place (s, y) of each view,
///
///     Q = R_tilt R_z (P - s a - (0, y, 0) + (0, 0, Z)),   image of Q through the lens
///
/// (core/camera/camera_geometry.h; a is the given camera's axis_rad). No stage is needed: the positions of
/// the views need not be known. Covariances are from the Jacobian, times the misfit where that is above 1.
/// @param lens  its intrinsics, distortion and axis count as exact; rotation, tilt and distance are ignored
/// @return fails with Reason::not_identifiable if no view has two tags, if tags coincide or the views do not
/// determine the mount; with Reason::no_convergence if the iteration does not converge
Result<CameraMount> fit_camera_mount(const CameraGeometry& lens, const std::vector<TargetView>& views);

}  // namespace fidservo::calib
