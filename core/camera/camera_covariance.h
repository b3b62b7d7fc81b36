// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How far a calibrated camera may be from what its calibration says, and what that makes of a length that it
// measures.
//
// The numbers p of core/camera/camera_geometry.h that the calibration against the stage finds have the
// covariance C. What lies between two image points, seen from one camera position,
//
//     d = back_project(to) - back_project(from),
//
// has to first order the covariance J C J^T with J = d d / d p. The camera's position cancels in it, and so
// does what the calibration gets wrong for both ends alike. The intrinsics that this calibration takes as
// given (focal length, principal point, all of the lens but k1) count as exact.
#include "core/camera/camera_geometry.h"

#include <span>
#include <vector>

#include <Eigen/Core>

namespace fidservo {

/// The numbers, in the order of their covariance.
enum CameraNumber : int {
    camera_distance,  ///< mm
    camera_rotation,  ///< rad
    camera_tilt_u,    ///< rad
    camera_tilt_v,    ///< rad
    camera_axis_y,    ///< rad
    camera_axis_z,    ///< rad
    camera_k1         ///< of the lens
};
/// How many numbers of a camera's geometry a calibration may leave open.
inline constexpr int camera_numbers = 7;

/// These numbers, in the order of the rig file's geometry_covariance.
using CameraNumbers = Eigen::Matrix<double, camera_numbers, 1>;
/// Their covariance, in the numbers' own units.
using CameraCovariance = Eigen::Matrix<double, camera_numbers, camera_numbers>;

/// The numbers of a camera.
CameraNumbers numbers_of(const CameraGeometry& camera);
/// The camera that has these numbers, and all else of the one given.
CameraGeometry with_numbers(CameraGeometry camera, const CameraNumbers& numbers);

/// Whether a symmetric matrix is one: no variance negative, no direction's below rounding.
bool is_covariance(const CameraCovariance& matrix);

/// The numbers that say a symmetric matrix: its lower triangle, row by row.
inline constexpr int camera_triangle_numbers = camera_numbers * (camera_numbers + 1) / 2;
/// The lower triangle of a symmetric matrix, row by row.
std::vector<double> lower_triangle(const CameraCovariance& matrix);
/// The symmetric matrix that has this lower triangle.
CameraCovariance from_lower_triangle(std::span<const double, camera_triangle_numbers> numbers);

/// J: rows plate x and y, a column for each number; mm per mm, rad or 1.
using VectorByCamera = Eigen::Matrix<double, 2, camera_numbers>;
/// J of the vector on the plate between two points of an image, seen from position s.
VectorByCamera vector_by_camera(const CameraGeometry& camera, const Eigen::Vector2d& from_px,
                                const Eigen::Vector2d& to_px, double s_mm);

/// J C J^T, mm^2; no variance is below zero, whatever rounding makes of it.
Eigen::Matrix2d vector_covariance_mm2(const VectorByCamera& slopes, const CameraCovariance& covariance);
/// The same of the vector between two points of an image, seen from position s.
Eigen::Matrix2d vector_covariance_mm2(const CameraGeometry& camera, const CameraCovariance& covariance,
                                      const Eigen::Vector2d& from_px, const Eigen::Vector2d& to_px,
                                      double s_mm);

}  // namespace fidservo
