#include "vision/servo/servo_law.h"

#include <cmath>

#include <visp3/core/vpHomogeneousMatrix.h>
#include <visp3/core/vpMatrix.h>
#include <visp3/core/vpVelocityTwistMatrix.h>
#include <visp3/visual_features/vpFeaturePoint.h>
#include <visp3/vs/vpServo.h>

namespace fidservo::vision {
namespace {

using Corners = std::array<Eigen::Vector2d, 4>;

/// A plate corner in the camera's frame, mm, seen from position s.
Eigen::Vector3d in_camera(const ServoParameters& parameters, const Eigen::Vector2d& plate_mm, double s_mm) {
    const Eigen::Vector3d on_platform(plate_mm.x() - s_mm, plate_mm.y(), parameters.camera.distance_mm);
    return parameters.platform_from_camera.transpose() * (on_platform - parameters.camera_on_platform_mm);
}

vpHomogeneousMatrix camera_from_platform(const ServoParameters& parameters) {
    const Eigen::Matrix3d rotation = parameters.platform_from_camera.transpose();
    const Eigen::Vector3d translation = -rotation * parameters.camera_on_platform_mm;
    vpHomogeneousMatrix pose;
    for (unsigned row = 0; row < 3; ++row) {
        for (unsigned column = 0; column < 3; ++column) pose[row][column] = rotation(row, column);
        pose[row][3] = translation(row);
    }
    return pose;
}

vpMatrix one_axis_jacobian() {
    vpMatrix jacobian(6, 1);
    jacobian = 0.0;
    jacobian[0][0] = 1.0;
    return jacobian;
}

}  // namespace

Corners corners_seen_from(const ServoParameters& parameters, const Corners& plate_corners_mm, double s_mm) {
    Corners seen;
    for (std::size_t k = 0; k < 4; ++k) {
        const Eigen::Vector3d point = in_camera(parameters, plate_corners_mm[k], s_mm);
        seen[k] =
            parameters.camera.principal_point_px + parameters.camera.focal_px * point.head<2>() / point.z();
    }
    return seen;
}

ServoMove servo_law(const ServoParameters& parameters, const ServoObservation& seen, double target_s_mm) {
    const CameraGeometry& camera = parameters.camera;
    vpServo task;
    task.setServo(vpServo::EYEINHAND_L_cVe_eJe);
    task.setInteractionMatrixType(vpServo::CURRENT, vpServo::PSEUDO_INVERSE);
    task.setLambda(parameters.gain);
    task.set_cVe(vpVelocityTwistMatrix(camera_from_platform(parameters)));
    task.set_eJe(one_axis_jacobian());

    std::array<vpFeaturePoint, 4> now;
    std::array<vpFeaturePoint, 4> goal;
    for (std::size_t k = 0; k < 4; ++k) {
        const Eigen::Vector3d target = in_camera(parameters, seen.plate_corners_mm[k], target_s_mm);
        const Eigen::Vector2d image = (seen.corners_px[k] - camera.principal_point_px) / camera.focal_px;
        now[k].buildFrom(image.x(), image.y(), target.z());
        goal[k].buildFrom(target.x() / target.z(), target.y() / target.z(), target.z());
        task.addFeature(now[k], goal[k]);
    }
    const double move_mm = task.computeControlLaw()[0];

    const vpMatrix inverse = task.getTaskJacobianPseudoInverse();
    const vpMatrix jacobian = task.getTaskJacobian();
    const vpColVector error = task.getError();
    Eigen::Matrix<double, 1, 8> move_by_corners;
    double left_over = 0.0;
    for (unsigned k = 0; k < 8; ++k) {
        move_by_corners(k) = -parameters.gain * inverse[0][k] / camera.focal_px;
        const double rest = error[k] + jacobian[k][0] * move_mm / parameters.gain;
        left_over += rest * rest;
    }
    const double variance = move_by_corners * seen.corner_covariance_px2 * move_by_corners.transpose();
    return {move_mm, std::sqrt(variance), std::sqrt(left_over / 8) * camera.focal_px};
}

}  // namespace fidservo::vision
