// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/camera/camera_covariance.h"

#include <Eigen/Eigenvalues>

namespace fidservo {

namespace {

/// Steps of the central differences: rounding and curvature both stay below 1e-7 of a derivative.
const CameraNumbers difference_steps{{1e-4, 1e-5, 1e-5, 1e-5, 1e-5, 1e-5, 1e-4}};

}  // namespace

CameraNumbers numbers_of(const CameraGeometry& camera) {
    return CameraNumbers{{camera.distance_mm, camera.rotation_rad, camera.tilt_rad.x(), camera.tilt_rad.y(),
                          camera.axis_rad.x(), camera.axis_rad.y(), camera.distortion.k1}};
}

CameraGeometry with_numbers(CameraGeometry camera, const CameraNumbers& numbers) {
    camera.distance_mm = numbers(camera_distance);
    camera.rotation_rad = numbers(camera_rotation);
    camera.tilt_rad = numbers.segment<2>(camera_tilt_u);
    camera.axis_rad = numbers.segment<2>(camera_axis_y);
    camera.distortion.k1 = numbers(camera_k1);
    return camera;
}

bool is_covariance(const CameraCovariance& matrix) {
    constexpr double rounding = 1e-6;
    const CameraNumbers variances = matrix.diagonal();
    if (!matrix.allFinite() || variances.minCoeff() < 0.0) return false;
    const CameraNumbers scale = (variances.array() > 0.0).select(variances.cwiseSqrt().cwiseInverse(), 1.0);
    const CameraCovariance correlation = scale.asDiagonal() * matrix * scale.asDiagonal();
    const Eigen::SelfAdjointEigenSolver<CameraCovariance> solver(correlation, Eigen::EigenvaluesOnly);
    return solver.eigenvalues().minCoeff() >= -rounding;
}

std::vector<double> lower_triangle(const CameraCovariance& matrix) {
    std::vector<double> numbers;
    numbers.reserve(camera_triangle_numbers);
    for (int row = 0; row < camera_numbers; ++row)
        for (int column = 0; column <= row; ++column) numbers.push_back(matrix(row, column));
    return numbers;
}

CameraCovariance from_lower_triangle(std::span<const double, camera_triangle_numbers> numbers) {
    CameraCovariance matrix;
    auto number = numbers.begin();
    for (int row = 0; row < camera_numbers; ++row)
        for (int column = 0; column <= row; ++column) matrix(row, column) = matrix(column, row) = *number++;
    return matrix;
}

VectorByCamera vector_by_camera(const CameraGeometry& camera, const Eigen::Vector2d& from_px,
                                const Eigen::Vector2d& to_px, double s_mm) {
    const CameraNumbers numbers = numbers_of(camera);
    VectorByCamera slopes;
    for (int k = 0; k < camera_numbers; ++k) {
        const auto vector_at = [&](double step) {
            CameraNumbers stepped = numbers;
            stepped(k) += step;
            const CameraGeometry other = with_numbers(camera, stepped);
            return (back_project(other, to_px, s_mm) - back_project(other, from_px, s_mm)).eval();
        };
        const double step = difference_steps(k);
        slopes.col(k) = (vector_at(step) - vector_at(-step)) / (2.0 * step);
    }
    return slopes;
}

Eigen::Matrix2d vector_covariance_mm2(const VectorByCamera& slopes, const CameraCovariance& covariance) {
    Eigen::Matrix2d squares_mm2 = slopes * covariance * slopes.transpose();
    squares_mm2.diagonal() = squares_mm2.diagonal().cwiseMax(0.0);
    return squares_mm2;
}

Eigen::Matrix2d vector_covariance_mm2(const CameraGeometry& camera, const CameraCovariance& covariance,
                                      const Eigen::Vector2d& from_px, const Eigen::Vector2d& to_px,
                                      double s_mm) {
    if (covariance.isZero(0.0)) return Eigen::Matrix2d::Zero();
    return vector_covariance_mm2(vector_by_camera(camera, from_px, to_px, s_mm), covariance);
}

}  // namespace fidservo
