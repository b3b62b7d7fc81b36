#include "vision/features/rest_image.h"

#include "core/camera_slopes.h"
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

}  // namespace fidservo::vision
