// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/servo/servo_law.h"

#include "core/camera/camera_slopes.h"

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <visp3/core/vpHomogeneousMatrix.h>
#include <visp3/core/vpMatrix.h>
#include <visp3/core/vpVelocityTwistMatrix.h>
#include <visp3/visual_features/vpFeaturePoint.h>
#include <visp3/vs/vpServo.h>

namespace fidservo::vision {
namespace {

using Vector8 = Eigen::Matrix<double, 8, 1>;
using Matrix8 = Eigen::Matrix<double, 8, 8>;

constexpr double least_misfit_px = 1e-3;  ///< no camera's geometry is known better

/// A plate point in the camera's frame, mm, seen from position s.
Eigen::Vector3d in_camera(const CameraGeometry& camera, const Eigen::Vector2d& plate_mm, double s_mm) {
    return camera_from_plate(camera) *
           (Eigen::Vector3d(plate_mm.x(), plate_mm.y(), camera.distance_mm) - s_mm * stage_axis(camera));
}

/// Depth at which a direction meets the plate, mm. The stage's axis is so nearly parallel to the plate that
/// any position on the way will do.
double depth_mm(const CameraGeometry& camera, const Eigen::Vector2d& ideal, double s_mm) {
    const Eigen::Vector3d upright = camera_from_plate(camera).col(2);
    const double height_mm = camera.distance_mm - s_mm * stage_axis(camera).z();
    return height_mm / upright.dot(Eigen::Vector3d(ideal.x(), ideal.y(), 1.0));
}

vpHomogeneousMatrix camera_from_platform(const CameraGeometry& camera) {
    const Eigen::Matrix3d rotation = camera_from_plate(camera);
    vpHomogeneousMatrix pose;
    for (unsigned row = 0; row < 3; ++row)
        for (unsigned column = 0; column < 3; ++column) pose[row][column] = rotation(row, column);
    return pose;
}

vpMatrix one_axis_jacobian(const CameraGeometry& camera) {
    const Eigen::Vector3d axis = stage_axis(camera);
    vpMatrix jacobian(6, 1);
    jacobian = 0.0;
    for (unsigned k = 0; k < 3; ++k) jacobian[k][0] = axis(k);
    return jacobian;
}

}  // namespace

ServoMove servo_law(const ServoParameters& parameters, const ServoObservation& seen, double target_s_mm) {
    const CameraGeometry& camera = parameters.camera;
    vpServo task;
    task.setServo(vpServo::EYEINHAND_L_cVe_eJe);
    task.setInteractionMatrixType(vpServo::MEAN, vpServo::PSEUDO_INVERSE);
    task.setLambda(parameters.gain);
    task.set_cVe(vpVelocityTwistMatrix(camera_from_platform(camera)));
    task.set_eJe(one_axis_jacobian(camera));

    std::array<vpFeaturePoint, 4> now;
    std::array<vpFeaturePoint, 4> goal;
    std::array<Eigen::Matrix2d, 4> feature_by_image;
    for (std::size_t k = 0; k < 4; ++k) {
        const Eigen::Vector2d ideal = ideal_point(camera, seen.corners_px[k]);
        const Eigen::Vector3d target = in_camera(camera, seen.plate_corners_mm[k], target_s_mm);
        feature_by_image[k] = ideal_by_image(camera, seen.corners_px[k]);
        now[k].buildFrom(ideal.x(), ideal.y(), depth_mm(camera, ideal, target_s_mm));
        goal[k].buildFrom(target.x() / target.z(), target.y() / target.z(), target.z());
        task.addFeature(now[k], goal[k]);
    }
    const double even_move_mm = task.computeControlLaw()[0];
    const vpMatrix task_jacobian = task.getTaskJacobian();
    const vpColVector task_error = task.getError();
    Vector8 jacobian, error;
    Matrix8 feature_by_corner = Matrix8::Zero();
    double left_over_px2 = 0.0;
    for (unsigned k = 0; k < 8; ++k) {
        jacobian(k) = task_jacobian[k][0];
        error(k) = task_error[k];
    }
    const Vector8 rest = error + jacobian * (even_move_mm / parameters.gain);
    for (int k = 0; k < 4; ++k) {
        feature_by_corner.block<2, 2>(2 * k, 2 * k) = feature_by_image[k];
        left_over_px2 += (feature_by_image[k].inverse() * rest.segment<2>(2 * k)).squaredNorm();
    }

    const double misfit_px2 = left_over_px2 / 8 + least_misfit_px * least_misfit_px;
    const Matrix8 trust_px2 = seen.corner_covariance_px2 + misfit_px2 * Matrix8::Identity();
    const Matrix8 trust = feature_by_corner * trust_px2 * feature_by_corner.transpose();
    const Vector8 weighted = trust.ldlt().solve(jacobian);
    const Vector8 move_by_feature = -parameters.gain / weighted.dot(jacobian) * weighted;
    const Vector8 move_by_corner = feature_by_corner.transpose() * move_by_feature;
    const double variance = move_by_corner.dot(seen.corner_covariance_px2 * move_by_corner);
    return {move_by_feature.dot(error), std::sqrt(variance), std::sqrt(left_over_px2 / 8)};
}

}  // namespace fidservo::vision
