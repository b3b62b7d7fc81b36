// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The models of core/camera/lens.h as templates over the number type, so that solvers can differentiate
// them automatically.
#include "core/camera/lens.h"

#include <cmath>

#include <Eigen/Core>

namespace fidservo {

/// A picture with Brown's decentring (tangential) terms added: 2 p1 x y + p2 (r2 + 2 x^2) and p1 (r2 + 2 y^2)
/// + 2 p2 x y, at (x, y).
template <class T>
Eigen::Matrix<T, 2, 1> decentred(const Eigen::Matrix<T, 2, 1>& picture, const T& p1, const T& p2,
                                 const Eigen::Matrix<T, 2, 1>& at) {
    const T &x = at.x(), &y = at.y();
    const T r2 = x * x + y * y;
    return {picture.x() + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
            picture.y() + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y};
}

/// (x', y') of (x, y) by a plumb_bob lens. @param numbers  k1, k2, p1, p2, k3
template <class T>
Eigen::Matrix<T, 2, 1> distorted(const T* numbers, const Eigen::Matrix<T, 2, 1>& ideal) {
    const T &k1 = numbers[0], &k2 = numbers[1], &p1 = numbers[2], &p2 = numbers[3], &k3 = numbers[4];
    const T r2 = ideal.x() * ideal.x() + ideal.y() * ideal.y();
    const T radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
    const Eigen::Matrix<T, 2, 1> along(ideal.x() * radial, ideal.y() * radial);
    return decentred(along, p1, p2, ideal);
}

/// theta_d / theta of an equidistant lens.
template <class T>
T angle_growth(const T& k1, const T& k2, const T& k3, const T& k4, const T& theta_rad) {
    const T square = theta_rad * theta_rad;
    return 1.0 + square * (k1 + square * (k2 + square * (k3 + square * k4)));
}

/// (x', y') of a direction by an equidistant lens, not limited to its domain. Straight behind the camera,
/// where there is no derivative, the picture is that of straight ahead, mirrored.
template <class T>
Eigen::Matrix<T, 2, 1> fisheye_picture(const T& k1, const T& k2, const T& k3, const T& k4,
                                       const Eigen::Matrix<T, 3, 1>& direction) {
    using std::atan2, std::sqrt;
    constexpr double straight = 1e-18;  // tan(theta)^2 below which theta = tan(theta) to rounding
    const T &x = direction.x(), &y = direction.y(), &z = direction.z();
    const T r2 = x * x + y * y;
    if (r2 <= straight * z * z) return {x / z, y / z};
    const T r = sqrt(r2);
    const T theta_rad = atan2(r, z);
    const T scale = theta_rad * angle_growth(k1, k2, k3, k4, theta_rad) / r;
    return {scale * x, scale * y};
}

}  // namespace fidservo
