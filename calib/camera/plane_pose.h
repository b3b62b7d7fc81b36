// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The pose of a camera relative to a flat target.
#include "calib/camera/target_view.h"
#include "core/camera/camera_geometry.h"

#include <optional>

#include <Eigen/Core>

namespace fidservo::calib {

/// The pose Q = R P + t, from the target's frame (z = 0 on the target, z pointing away from the camera) to
/// the camera's, mm.
struct PlanePose {
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();   ///< R: from the target's frame to the camera's
    Eigen::Vector3d shift_mm = Eigen::Vector3d::UnitZ();  ///< t: the target's origin in the camera's frame

    /// The camera's centre in the target's frame, mm: (s, y, -Z).
    Eigen::Vector3d centre_mm() const { return -turn.transpose() * shift_mm; }
};

/// H with (u, v, 1) ~ H (X, Y, 1): normalised direct linear transform over all tags' corners, with the lens's
/// distortion taken out and the principal point as origin. Empty if the corners do not determine it.
/// Source: Hartley, Zisserman, Multiple View Geometry, 2nd ed., 2004, alg. 4.2.
std::optional<Eigen::Matrix3d> target_homography(const CameraGeometry& lens, const TargetView& view);

/// The pose that corresponds to a homography of target_homography(), with R made a rotation in the
/// least-squares sense. Source: Zhang, A flexible new technique for camera calibration, IEEE PAMI 22(11),
/// 2000, sec. 3.1.
PlanePose pose_of_homography(const CameraGeometry& lens, const Eigen::Matrix3d& homography);

/// A start value for the pose of a view with a given lens: from its homography. For an equidistant lens,
/// whose rays r may come from behind the camera's centre, the same transform is applied to the rays, r x H
/// (X, Y, 1) = 0. Empty if the corners do not determine the pose, or if the lens has no ray at one of them.
std::optional<PlanePose> plane_pose(const CameraGeometry& lens, const TargetView& view);

/// The camera at a pose: rotation_rad, tilt_rad and distance_mm follow from the pose, the rest from the lens.
/// The plate's origin is shifted such that the camera's foot is at (s, y) = (0, 0).
CameraGeometry camera_at(const CameraGeometry& lens, const PlanePose& pose);

}  // namespace fidservo::calib
