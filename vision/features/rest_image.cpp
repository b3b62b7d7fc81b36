// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/features/rest_image.h"

#include "core/camera/camera_slopes.h"
#include "core/units.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/LU>

namespace fidservo::vision {

LocalPicture picture_around(const RestImage& image, const Eigen::Vector2d& image_px) {
    const CameraGeometry& camera = image.camera.geometry;
    const Eigen::Matrix2d slope = plate_by_image(camera, image_px, image.axis_mm.x());
    return {slope, slope.inverse(), mm_per_px_at(camera, image_px, image.axis_mm.x())};
}

double bend_std_um(const RestImage& image, const Eigen::Vector2d& image_px,
                   const Eigen::Vector2d& half_extent_px) {
    if (looks_straight(image.camera.geometry)) return 0.0;
    const Eigen::Vector2d centre = to_plate(image, image_px);
    double most_mm = 0.0;
    for (const Eigen::Vector2d& part : std::array<Eigen::Vector2d, 4>{{{1, 0}, {0, 1}, {1, 1}, {1, -1}}}) {
        const Eigen::Vector2d arm = half_extent_px.cwiseProduct(part);
        const Eigen::Vector2d both = to_plate(image, image_px + arm) + to_plate(image, image_px - arm);
        most_mm = std::max(most_mm, (0.5 * both - centre).norm());
    }
    return um_from_mm(most_mm) / std::sqrt(3.0);
}

Eigen::Vector2d plate_std_um(const LocalPicture& picture, const Eigen::Matrix2d& covariance_px2) {
    const Eigen::Matrix2d covariance_mm2 =
        picture.plate_by_image * covariance_px2 * picture.plate_by_image.transpose();
    return covariance_mm2.diagonal().cwiseSqrt() * um_per_mm;
}

double calibration_std_um(const RestImage& image, const Eigen::Vector2d& from_px,
                          const Eigen::Vector2d& to_px) {
    const Eigen::Vector2d along = (to_plate(image, to_px) - to_plate(image, from_px)).normalized();
    const Eigen::Matrix2d covariance_mm2 = vector_covariance_mm2(
        image.camera.geometry, image.camera.geometry_covariance, from_px, to_px, image.axis_mm.x());
    return um_from_mm(std::sqrt(along.dot(covariance_mm2 * along)));
}

Eigen::Matrix2d around_covariance_mm2(const RestImage& image, const Eigen::Vector2d& image_px) {
    Eigen::Matrix2d covariance_mm2 =
        vector_covariance_mm2(image.camera.geometry, image.camera.geometry_covariance, image.anchor_px,
                              image_px, image.axis_mm.x());
    covariance_mm2.diagonal() += image.axis_std_mm.cwiseAbs2();
    return covariance_mm2;
}

std::array<Measured, 2> place_um(const RestImage& image, const Eigen::Vector2d& image_px,
                                 const Eigen::Matrix2d& covariance_px2, double extra_um) {
    const Eigen::Array2d own_um = plate_std_um(picture_around(image, image_px), covariance_px2);
    const Eigen::Array2d around_um =
        around_covariance_mm2(image, image_px).diagonal().cwiseSqrt() * um_per_mm;
    const Eigen::Array2d std_um = (own_um.square() + around_um.square() + extra_um * extra_um).sqrt();
    const Eigen::Vector2d at_um = to_plate(image, image_px) * um_per_mm;
    return {Measured{at_um.x(), std_um.x()}, Measured{at_um.y(), std_um.y()}};
}

}  // namespace fidservo::vision
