// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The uncertainty of a camera's calibration, and the uncertainty of a length measured with the camera that
// follows from it.
//
// The numbers p of core/camera/camera_geometry.h that the calibration against the stage finds have the
// covariance C. The vector on the plate between two image points, seen from one camera position,
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

/// The calibrated numbers p of a camera, in the order of rows and columns of their covariance.
enum CameraNumber : int {
    camera_distance,  ///< Z, mm
    camera_rotation,  ///< rad
    camera_tilt_u,    ///< rotation vector's part along u, rad
    camera_tilt_v,    ///< rotation vector's part along v, rad
    camera_axis_y,    ///< the stage axis's slope towards plate y, rad
    camera_axis_z,    ///< the stage axis's slope towards plate z, rad
    camera_k1         ///< the lens's first radial coefficient
};
/// How many numbers of a camera's geometry have a covariance.
inline constexpr int camera_numbers = 7;

/// The calibrated numbers p of a camera, in the order of CameraNumber.
using CameraNumbers = Eigen::Matrix<double, camera_numbers, 1>;
/// The covariance C of the numbers p, in their own units (mm, rad, 1).
using CameraCovariance = Eigen::Matrix<double, camera_numbers, camera_numbers>;

/// The calibrated numbers p of a camera.
CameraNumbers numbers_of(const CameraGeometry& camera);
/// A camera with these numbers p; all else is as in the camera given.
CameraGeometry with_numbers(CameraGeometry camera, const CameraNumbers& numbers);

/// Whether a symmetric matrix is a covariance: no variance on its diagonal is negative, and no eigenvalue is
/// negative beyond rounding.
bool is_covariance(const CameraCovariance& matrix);

/// How many numbers the lower triangle of a camera's covariance has.
inline constexpr int camera_triangle_numbers = camera_numbers * (camera_numbers + 1) / 2;
/// The lower triangle of a symmetric matrix, row by row.
std::vector<double> lower_triangle(const CameraCovariance& matrix);
/// The symmetric matrix that has this lower triangle.
CameraCovariance from_lower_triangle(std::span<const double, camera_triangle_numbers> numbers);

/// J = d d / d p. Its rows are the plate x and y of the vector d, its columns the numbers p; in mm per mm,
/// per rad or per unit of k1.
using VectorByCamera = Eigen::Matrix<double, 2, camera_numbers>;
/// J of the vector on the plate between two points of an image, seen from position s.
VectorByCamera vector_by_camera(const CameraGeometry& camera, const Eigen::Vector2d& from_px,
                                const Eigen::Vector2d& to_px, double s_mm);

/// J C J^T, mm^2. Variances that rounding makes negative are set to zero.
Eigen::Matrix2d vector_covariance_mm2(const VectorByCamera& slopes, const CameraCovariance& covariance);
/// J C J^T, mm^2, of the vector on the plate between two points of an image, seen from position s.
Eigen::Matrix2d vector_covariance_mm2(const CameraGeometry& camera, const CameraCovariance& covariance,
                                      const Eigen::Vector2d& from_px, const Eigen::Vector2d& to_px,
                                      double s_mm);

}  // namespace fidservo
