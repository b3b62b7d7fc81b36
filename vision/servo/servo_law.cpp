#include "vision/servo/servo_law.h"

#include "core/camera_slopes.h"

#include <cmath>

#include <Eigen/LU>
#include <visp3/core/vpHomogeneousMatrix.h>
#include <visp3/core/vpMatrix.h>
#include <visp3/core/vpVelocityTwistMatrix.h>
#include <visp3/visual_features/vpFeaturePoint.h>
#include <visp3/vs/vpServo.h>

namespace fidservo::vision {
namespace {

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
    const double move_mm = task.computeControlLaw()[0];

    const vpMatrix inverse = task.getTaskJacobianPseudoInverse();
    const vpMatrix jacobian = task.getTaskJacobian();
    const vpColVector error = task.getError();
    Eigen::Matrix<double, 1, 8> move_by_corners;
    double left_over_px2 = 0.0;
    for (unsigned k = 0; k < 4; ++k) {
        const Eigen::RowVector2d move_by_feature(inverse[0][2 * k], inverse[0][2 * k + 1]);
        const Eigen::Vector2d rest(error[2 * k] + jacobian[2 * k][0] * move_mm / parameters.gain,
                                   error[2 * k + 1] + jacobian[2 * k + 1][0] * move_mm / parameters.gain);
        move_by_corners.segment<2>(2 * k) = -parameters.gain * move_by_feature * feature_by_image[k];
        left_over_px2 += (feature_by_image[k].inverse() * rest).squaredNorm();
    }
    const double variance = move_by_corners * seen.corner_covariance_px2 * move_by_corners.transpose();
    return {move_mm, std::sqrt(variance), std::sqrt(left_over_px2 / 8)};
}

}  // namespace fidservo::vision
