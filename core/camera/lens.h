// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A camera's lens: from the direction of a ray in the camera's frame, x to the right, y down, z ahead, to its
// picture (x', y') in focal lengths from the principal point, and back. Two models.
//
// plumb_bob, with (x, y) = (Q_x, Q_y) / Q_z, for rays ahead of the camera:
//
//     x' = x (1 + k1 r2 + k2 r2^2 + k3 r2^3) + 2 p1 x y + p2 (r2 + 2 x^2),   r2 = x^2 + y^2
//     y' = y (1 + k1 r2 + k2 r2^2 + k3 r2^3) + p1 (r2 + 2 y^2) + 2 p2 x y
//
// equidistant (fisheye), for rays of any direction, those behind the camera's centre (theta > pi / 2)
// included:
//
//     r = |(Q_x, Q_y)|,   theta = atan2(r, Q_z)
//     (x', y') = theta_d / r (Q_x, Q_y),   theta_d = theta (1 + k1 theta^2 + k2 theta^4 + k3 theta^6 + k4
//     theta^8)
//
// The model's domain is theta from 0 to where theta_d ceases to rise: there it is one-to-one.
//
// Sources: Brown, Close-range camera calibration, Photogrammetric Engineering 37(8), 1971, as OpenCV and ROS
// ("plumb_bob") write it; Kannala, Brandt, A generic camera model and calibration method for conventional,
// wide-angle, and fish-eye lenses, IEEE PAMI 28(8), 2006, as OpenCV ("fisheye") and ROS ("equidistant") do.
#include <array>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace fidservo {

/// Which formula pictures a direction.
enum class LensModel {
    plumb_bob,    ///< Brown's: radial and tangential
    equidistant,  ///< Kannala and Brandt's, for fisheye lenses
};
/// All of them.
inline constexpr std::array lens_models{LensModel::plumb_bob, LensModel::equidistant};

/// As rig files, ROS and the command line name it.
std::string_view name_of(LensModel model);

/// A model and its coefficients: k1, k2, p1, p2, k3 of plumb_bob, k1 to k4 of equidistant.
struct LensDistortion {
    /// Radial k1, k2, k3 and tangential p1, p2; an equidistant lens has k1 to k4 only.
    double k1 = 0.0, k2 = 0.0, p1 = 0.0, p2 = 0.0, k3 = 0.0;
    double k4 = 0.0;                         ///< of an equidistant lens only
    LensModel model = LensModel::plumb_bob;  ///< which formula the coefficients belong to

    /// Whether the lens is a pinhole: plumb_bob with all coefficients 0.
    bool is_none() const {
        return model == LensModel::plumb_bob && k1 == 0.0 && k2 == 0.0 && p1 == 0.0 && p2 == 0.0 && k3 == 0.0;
    }
};

/// How many coefficients a model has: 5, 4.
std::size_t coefficients_of(LensModel model);

/// The coefficients in the order in which OpenCV, ROS and the rig file list them: k1, k2, p1, p2, k3; k1 to
/// k4.
std::vector<double> numbers_of(const LensDistortion& lens);

/// @param numbers  the coefficients in the same order, coefficients_of(model) of them
LensDistortion distortion_of(LensModel model, const std::vector<double>& numbers);

/// (x', y') of a direction of any length. NaN beyond the domain of an equidistant lens.
Eigen::Vector2d picture_of(const LensDistortion& lens, const Eigen::Vector3d& direction);

/// The direction whose picture is (x', y'), by Newton's method to rounding. Of a plumb_bob lens it is (x, y,
/// 1), valid where the picture is one-to-one; of an equidistant one it has length 1, and is NaN where no
/// direction of the domain has this picture.
Eigen::Vector3d ray_of(const LensDistortion& lens, const Eigen::Vector2d& pictured);

/// d ray_of() / d (x', y'), at a direction that ray_of() gave.
Eigen::Matrix<double, 3, 2> ray_slope(const LensDistortion& lens, const Eigen::Vector3d& ray);

/// (x', y') of (x, y), the direction (x, y, 1).
Eigen::Vector2d distort(const LensDistortion& lens, const Eigen::Vector2d& ideal);

/// (x, y) of (x', y'); NaN where ray_of() is NaN or does not point ahead.
Eigen::Vector2d undistort(const LensDistortion& lens, const Eigen::Vector2d& distorted);

/// d (x', y') / d (x, y).
Eigen::Matrix2d distortion_slope(const LensDistortion& lens, const Eigen::Vector2d& ideal);

/// The largest theta, rad, of an equidistant lens's domain, up to which theta_d rises; at most pi.
double domain_rad(const LensDistortion& lens);

}  // namespace fidservo
