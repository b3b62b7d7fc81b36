#pragma once
// How far a calibrated camera may be from what its calibration says, and what that makes of a length that it
// measures.
//
// The numbers p of core/camera_geometry.h that the calibration against the stage finds have the covariance C.
// What lies between two image points, seen from one camera position,
//
//     d = back_project(to) - back_project(from),
//
// has to first order the covariance J C J^T with J = d d / d p. The camera's position cancels in it, and so
// does what the calibration gets wrong for both ends alike. The intrinsics that this calibration takes as
// given (focal length, principal point, all of the lens but k1) count as exact.
#include "core/camera_geometry.h"

#include <span>
#include <vector>

#include <Eigen/Core>

namespace fidservo {

/// The numbers, in the order of their covariance.
enum CameraNumber : int {
    camera_distance,  ///< mm
    camera_rotation,  ///< rad
    camera_tilt_u,    ///< rad
    camera_tilt_v,
    camera_axis_y,  ///< rad
    camera_axis_z,
    camera_k1
};
inline constexpr int camera_numbers = 7;

using CameraNumbers = Eigen::Matrix<double, camera_numbers, 1>;
using CameraCovariance = Eigen::Matrix<double, camera_numbers, camera_numbers>;

CameraNumbers numbers_of(const CameraGeometry& camera);
CameraGeometry with_numbers(CameraGeometry camera, const CameraNumbers& numbers);

/// Whether a symmetric matrix is one: no variance negative, no direction's below rounding.
bool is_covariance(const CameraCovariance& matrix);

/// The numbers that say a symmetric matrix: its lower triangle, row by row.
inline constexpr int camera_triangle_numbers = camera_numbers * (camera_numbers + 1) / 2;
std::vector<double> lower_triangle(const CameraCovariance& matrix);
CameraCovariance from_lower_triangle(std::span<const double, camera_triangle_numbers> numbers);

/// J: rows plate x and y, a column for each number; mm per mm, rad or 1.
using VectorByCamera = Eigen::Matrix<double, 2, camera_numbers>;
VectorByCamera vector_by_camera(const CameraGeometry& camera, const Eigen::Vector2d& from_px,
                                const Eigen::Vector2d& to_px, double s_mm);

/// J C J^T, mm^2; no variance is below zero, whatever rounding makes of it.
Eigen::Matrix2d vector_covariance_mm2(const VectorByCamera& slopes, const CameraCovariance& covariance);
Eigen::Matrix2d vector_covariance_mm2(const CameraGeometry& camera, const CameraCovariance& covariance,
                                      const Eigen::Vector2d& from_px, const Eigen::Vector2d& to_px,
                                      double s_mm);

}  // namespace fidservo
