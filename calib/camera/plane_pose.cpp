// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/camera/plane_pose.h"

#include "calib/dense.h"
#include "core/camera/camera_slopes.h"
#include "vision/tags/tag_choice.h"

#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>

namespace fidservo::calib {
namespace {

/// Shift and scale that bring points to mean zero and r.m.s. distance sqrt(2).
Eigen::Matrix3d normaliser(const Eigen::Matrix2Xd& points) {
    const Eigen::Vector2d mean = points.rowwise().mean();
    const double spread = std::sqrt((points.colwise() - mean).colwise().squaredNorm().mean() / 2.0);
    Eigen::Matrix3d map = Eigen::Matrix3d::Identity();
    map.diagonal() << 1.0 / spread, 1.0 / spread, 1.0;
    map.topRightCorner<2, 1>() = -mean / spread;
    return map;
}

/// Where a lens without distortion would show an image point, from the principal point, px.
Eigen::Vector2d straightened(const CameraGeometry& lens, const Eigen::Vector2d& image_px) {
    Eigen::Vector2d pictured = (image_px - lens.principal_point_px) / lens.focal_px;
    pictured.y() /= lens.focal_ratio;
    return lens.focal_px * undistort(lens.distortion, pictured);
}

}  // namespace

std::optional<Eigen::Matrix3d> target_homography(const CameraGeometry& lens, const TargetView& view) {
    const auto points = static_cast<Eigen::Index>(4 * view.tags.size());
    if (points == 0) return std::nullopt;
    Eigen::Matrix2Xd printed(2, points), seen(2, points);
    Eigen::Index column = 0;
    for (const TagSight& sight : view.tags) {
        const auto corners_mm = vision::corners_mm(sight.printed);
        for (std::size_t k = 0; k < 4; ++k, ++column) {
            printed.col(column) = corners_mm[k];
            seen.col(column) = straightened(lens, sight.seen.detection.corners_px[k]);
        }
    }
    const Eigen::Matrix3d from = normaliser(printed), to = normaliser(seen);
    Eigen::MatrixXd system(2 * points, 9);
    for (Eigen::Index k = 0; k < points; ++k) {
        const Eigen::RowVector3d p = (from * printed.col(k).homogeneous()).transpose();
        const Eigen::Vector2d q = (to * seen.col(k).homogeneous()).head<2>();
        system.row(2 * k) << p, Eigen::RowVector3d::Zero(), -q.x() * p;
        system.row(2 * k + 1) << Eigen::RowVector3d::Zero(), p, -q.y() * p;
    }
    const SymmetricParts parts = symmetric_parts(product(system.transpose(), system));
    if (!system.allFinite() || !(parts.values(1) > 1e-12 * parts.values(8))) return std::nullopt;
    const Eigen::Matrix3d normalised = parts.vectors.col(0).reshaped<Eigen::RowMajor>(3, 3);
    Eigen::Matrix3d homography = to.inverse() * normalised * from;
    return homography / homography.leftCols<1>().norm();
}

namespace {

PlanePose pose_of_columns(const Eigen::Matrix3d& columns) {
    Eigen::Matrix3d turn;
    turn << columns.col(0), columns.col(1), columns.col(0).cross(columns.col(1));
    const Eigen::JacobiSVD<Eigen::Matrix3d, Eigen::NoQRPreconditioner> parts(
        turn, Eigen::ComputeFullU | Eigen::ComputeFullV);
    return {parts.matrixU() * parts.matrixV().transpose(), columns.col(2)};
}

}  // namespace

PlanePose pose_of_homography(const CameraGeometry& lens, const Eigen::Matrix3d& homography) {
    const Eigen::DiagonalMatrix<double, 3> to_rays(1.0 / lens.focal_px, 1.0 / lens.focal_px, 1.0);
    Eigen::Matrix3d columns = to_rays * homography;
    columns /= std::sqrt(columns.col(0).norm() * columns.col(1).norm());
    if (columns(2, 2) < 0.0) columns = -columns;
    return pose_of_columns(columns);
}

std::optional<PlanePose> plane_pose(const CameraGeometry& lens, const TargetView& view) {
    if (lens.distortion.model == LensModel::plumb_bob) {
        const auto homography = target_homography(lens, view);
        if (!homography) return std::nullopt;
        return pose_of_homography(lens, *homography);
    }
    const auto points = static_cast<Eigen::Index>(4 * view.tags.size());
    if (points == 0) return std::nullopt;
    Eigen::Matrix2Xd printed(2, points);
    Eigen::Matrix3Xd rays(3, points);
    Eigen::Index column = 0;
    for (const TagSight& sight : view.tags) {
        const auto corners_mm = vision::corners_mm(sight.printed);
        for (std::size_t k = 0; k < 4; ++k, ++column) {
            printed.col(column) = corners_mm[k];
            rays.col(column) = ray_of(lens.distortion, pictured_at(lens, sight.seen.detection.corners_px[k]));
        }
    }
    if (!rays.allFinite()) return std::nullopt;
    const Eigen::Matrix3d from = normaliser(printed);
    Eigen::MatrixXd system(3 * points, 9);
    for (Eigen::Index k = 0; k < points; ++k) {
        const Eigen::RowVector3d p = (from * printed.col(k).homogeneous()).transpose();
        const Eigen::Vector3d r = rays.col(k);
        const Eigen::RowVector3d none = Eigen::RowVector3d::Zero();
        system.row(3 * k) << none, -r.z() * p, r.y() * p;
        system.row(3 * k + 1) << r.z() * p, none, -r.x() * p;
        system.row(3 * k + 2) << -r.y() * p, r.x() * p, none;
    }
    const SymmetricParts parts = symmetric_parts(product(system.transpose(), system));
    if (!(parts.values(1) > 1e-12 * parts.values(8))) return std::nullopt;
    Eigen::Matrix3d columns = parts.vectors.col(0).reshaped<Eigen::RowMajor>(3, 3) * from;
    columns /= std::sqrt(columns.col(0).norm() * columns.col(1).norm());
    const Eigen::Matrix3Xd placed = columns * printed.colwise().homogeneous();
    if (placed.cwiseProduct(rays).sum() < 0.0) columns = -columns;
    return pose_of_columns(columns);
}

CameraGeometry camera_at(const CameraGeometry& lens, const PlanePose& pose) {
    // R = R_tilt R_z with R_tilt about an axis in the image plane: R_tilt takes the z axis to R's third
    // column.
    const Eigen::Quaterniond tilt = turn_between(Eigen::Vector3d::UnitZ(), pose.turn.col(2));
    const Eigen::AngleAxisd tilt_vector(tilt);
    const Eigen::Matrix3d turn = tilt.toRotationMatrix().transpose() * pose.turn;
    CameraGeometry camera = lens;
    camera.tilt_rad = tilt_vector.angle() * tilt_vector.axis().head<2>();
    camera.rotation_rad = std::atan2(turn(1, 0), turn(0, 0));
    camera.distance_mm = -pose.centre_mm().z();
    return camera;
}

}  // namespace fidservo::calib
