// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The visual servo law: from a tag's corners in the image to a move of the stage.
//
// This folder is compiled as C++17, as its library requires; the header keeps to that.
#include "core/camera/camera_geometry.h"

#include <array>

#include <Eigen/Core>

namespace fidservo::vision {

/// The camera's geometry, and the gain of the law.
struct ServoParameters {
    CameraGeometry camera;  ///< that looks at the plate
    double gain = 1.0;      ///< lambda; with 1 one step goes the whole way
};

/// What the camera sees of one tag, and where that tag is.
struct ServoObservation {
    std::array<Eigen::Vector2d, 4> corners_px;          ///< pixel centres at integers
    Eigen::Matrix<double, 8, 8> corner_covariance_px2;  ///< of (u0, v0, u1, v1, ...)
    std::array<Eigen::Vector2d, 4> plate_corners_mm;    ///< nominal places of the same corners on the plate
};

/// A relative setpoint of the stage.
struct ServoMove {
    double move_mm;  ///< distance along the stage axis from where the stage was in the middle of the exposure
    double std_mm;   ///< propagated from the corners
    double residual_px;  ///< r.m.s. of the image error that no motion along the axis removes
};

/// Image-based visual servoing, eye in hand, on the four corners as point features s = (x, y) of the
/// undistorted image:
///
///     e = s - s*,     q = -lambda (J^T W J)^-1 J^T W e,     J = L cVe eJe
///
/// W: inverse of the corners' covariance plus m^2 on its diagonal, m the r.m.s. image error that remains with
/// W = 1, q = -lambda J^+ e. So all corners have about the same weight where errors of the camera's geometry
/// exceed the corners' noise, and a poorly seen corner has little weight. L: mean of the interaction matrices
/// of the points at their depths, now and at the target; cVe: velocity twist of the plate's frame, moved with
/// the camera, in the camera's; eJe = (a, 0): the stage's one axis; s*: the corners seen from camera position
/// `target_s_mm`, y = 0. Looking straight down, e is linear in the stage's position, so that one step with
/// lambda = 1 is the exact solution target - s; for a tilted camera steps converge to it. The frame must have
/// been taken at rest, or at known stage positions: the move counts from the exposure, not from the frame's
/// arrival. Source: Chaumette and Hutchinson, "Visual servo control", 2006, eq. 4 and 5; the mean: Malis,
/// "Improving vision-based control using efficient second-order minimization techniques", 2004; ViSP's
/// vpServo.
ServoMove servo_law(const ServoParameters& parameters, const ServoObservation& seen, double target_s_mm);

}  // namespace fidservo::vision
