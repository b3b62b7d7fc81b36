#pragma once
// The lens distortion of core/camera_geometry.h for any kind of number, those of solvers that differentiate
// included.
#include "core/camera_geometry.h"

#include <array>
#include <span>

#include <Eigen/Core>

namespace fidservo {

/// k1, k2, p1, p2, k3, as OpenCV, ROS and the rig file list them.
using DistortionNumbers = std::array<double, 5>;

inline DistortionNumbers numbers_of(const LensDistortion& lens) {
    return {lens.k1, lens.k2, lens.p1, lens.p2, lens.k3};
}

inline LensDistortion distortion_of(std::span<const double, 5> numbers) {
    return {numbers[0], numbers[1], numbers[2], numbers[3], numbers[4]};
}

/// (x', y') of (x, y) under the five numbers.
template <class T>
Eigen::Matrix<T, 2, 1> distorted(const T* numbers, const Eigen::Matrix<T, 2, 1>& ideal) {
    const T &k1 = numbers[0], &k2 = numbers[1], &p1 = numbers[2], &p2 = numbers[3], &k3 = numbers[4];
    const T &x = ideal.x(), &y = ideal.y();
    const T r2 = x * x + y * y;
    const T radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
    return {x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
            y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y};
}

}  // namespace fidservo
