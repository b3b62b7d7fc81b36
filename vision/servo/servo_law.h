#pragma once
// The visual servo law: from a tag's corners in the image to a move of the stage.
//
// This room is compiled as C++17 for its library's sake; the header stays within it.
#include "core/camera_geometry.h"

#include <array>

#include <Eigen/Core>

namespace fidservo::vision {

/// How the camera sits on the platform, and how hard the law pulls. Platform frame: x along the stage axis, y
/// down in the image, z towards the plate, origin where the nominal camera's is. Camera frame: x along u,
/// y along v, z along the optical axis.
struct ServoParameters {
    CameraGeometry camera;
    Eigen::Matrix3d platform_from_camera =
        Eigen::Matrix3d::Identity();  ///< rotation: p_platform = R p_camera
    Eigen::Vector3d camera_on_platform_mm = Eigen::Vector3d::Zero();
    double gain = 1.0;  ///< lambda; 1 makes the whole way in one step
};

/// What the camera sees of one tag, and where that tag is.
struct ServoObservation {
    std::array<Eigen::Vector2d, 4> corners_px;          ///< pixel centres at integers
    Eigen::Matrix<double, 8, 8> corner_covariance_px2;  ///< of (u0, v0, u1, v1, ...)
    std::array<Eigen::Vector2d, 4> plate_corners_mm;    ///< the same corners on the plate
};

/// A relative setpoint of the stage.
struct ServoMove {
    double move_mm;      ///< along the stage axis, from where the stage was in the middle of the exposure
    double std_mm;       ///< propagated from the corners
    double residual_px;  ///< r.m.s. of the image error that no move along the axis removes
};

/// Image-based visual servoing, eye in hand, on the four corners as point features s = (x, y):
///
///     e = s - s*,     q = -lambda (L cVe eJe)^+ e
///
/// L: interaction matrix of the points at depth Z; cVe: velocity twist of the platform in the camera; eJe =
/// (1, 0, 0, 0, 0, 0)^T: the one axis of the stage; s*: the corners seen from camera position `target_s_mm`,
/// y = 0. Looking straight down, e is linear in the stage's position, so that one step with lambda = 1 is the
/// exact solution target - s. The law must be given a frame whose stage positions are known or at rest: the
/// move counts from the exposure, not from the frame's arrival. Source: Chaumette and Hutchinson, "Visual
/// servo control", 2006, eq. 4 and 5; ViSP's vpServo.
ServoMove servo_law(const ServoParameters& parameters, const ServoObservation& seen, double target_s_mm);

/// The corners as the camera would see them from position s: the law's s*, in px.
std::array<Eigen::Vector2d, 4> corners_seen_from(const ServoParameters& parameters,
                                                 const std::array<Eigen::Vector2d, 4>& plate_corners_mm,
                                                 double s_mm);

}  // namespace fidservo::vision
