// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/camera/pictured_corners.h"

#include "vision/tags/tag_choice.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

namespace fidservo::calib {

namespace {

constexpr int picture_cells = 8;
constexpr int picture_points = (picture_cells + 1) * (picture_cells + 1);

/// Of point i, in units of half the tag's side.
Eigen::Vector2d point_at(int i) {
    const int column = i % (picture_cells + 1), row = i / (picture_cells + 1);
    return {2.0 * column / picture_cells - 1.0, 2.0 * row / picture_cells - 1.0};
}

/// The border is an edge all along; of the lines between cells about half.
double weight_at(const Eigen::Vector2d& p) {
    return p.cwiseAbs().maxCoeff() == 1.0 ? 1.0 : 0.5;
}

Eigen::Matrix<double, 2, 8> perspective_changes(const Eigen::Vector2d& p) {
    const double x = p.x(), y = p.y();
    Eigen::Matrix<double, 2, 8> changes;
    changes << 1, 0, x, 0, y, 0, x * x, x * y, 0, 1, 0, x, 0, y, x * y, y * y;
    return changes;
}

using Smoother = Eigen::Matrix<double, 8, Eigen::Dynamic>;

/// From the shifts of all points to those of the nearest perspective picture's corners.
Smoother make_smoother() {
    Eigen::Matrix<double, 8, 8> normal = Eigen::Matrix<double, 8, 8>::Zero();
    Smoother weighted(8, 2 * picture_points);
    for (int i = 0; i < picture_points; ++i) {
        const Eigen::Vector2d p = point_at(i);
        const auto changes = perspective_changes(p);
        weighted.middleCols<2>(2 * i) = weight_at(p) * changes.transpose();
        normal += weighted.middleCols<2>(2 * i) * changes;
    }
    const std::array<Eigen::Vector2d, 4> corners{Eigen::Vector2d(-1, 1), Eigen::Vector2d(1, 1),
                                                 Eigen::Vector2d(1, -1), Eigen::Vector2d(-1, -1)};
    Eigen::Matrix<double, 8, 8> at_corners;
    for (int k = 0; k < 4; ++k)
        at_corners.middleRows<2>(2 * k) = perspective_changes(corners[static_cast<std::size_t>(k)]);
    return at_corners * normal.ldlt().solve(weighted);
}

}  // namespace

std::array<Eigen::Vector2d, 4> pictured_corners(const CameraGeometry& camera, const PlateTag& tag,
                                                double s_mm) {
    static const Smoother smoother = make_smoother();
    CameraGeometry pinhole = camera;
    pinhole.distortion = {};
    std::array<Eigen::Vector2d, 4> corners = vision::corners_mm(tag);
    for (Eigen::Vector2d& corner : corners) corner = project(pinhole, corner, s_mm);
    if (camera.distortion.is_none()) return corners;

    const Eigen::Rotation2Dd tag_turn(tag.angle_rad);
    const Eigen::Vector2d along = (corners[1] - corners[0]).normalized();
    Eigen::Matrix2d picture_from_tag;
    picture_from_tag << along.x(), -along.y(), along.y(), along.x();
    Eigen::Matrix<double, 2 * picture_points, 1> shift;
    for (int i = 0; i < picture_points; ++i) {
        const Eigen::Vector2d plate_mm = tag.centre_mm + tag_turn * (0.5 * tag.side_mm * point_at(i));
        const Eigen::Vector2d ideal_px = project(pinhole, plate_mm, s_mm);
        Eigen::Vector2d ideal = (ideal_px - camera.principal_point_px) / camera.focal_px;
        ideal.y() /= camera.focal_ratio;
        const Eigen::Vector2d moved = camera.focal_px * (distort(camera.distortion, ideal) - ideal);
        shift.segment<2>(2 * i) =
            picture_from_tag.transpose() * Eigen::Vector2d(moved.x(), camera.focal_ratio * moved.y());
    }
    const Eigen::Matrix<double, 8, 1> smoothed = smoother * shift;
    for (int k = 0; k < 4; ++k)
        corners[static_cast<std::size_t>(k)] += picture_from_tag * smoothed.segment<2>(2 * k);
    return corners;
}

}  // namespace fidservo::calib
