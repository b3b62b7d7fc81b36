// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// An image taken at rest together with the camera's parameters and position, and how results measured in it
// are stated: a value with its standard uncertainty.

#include "core/camera/camera_parameters.h"

#include <array>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

namespace fidservo::vision {

/// A value and its standard uncertainty (1 sigma); the field that holds it names the unit.
struct Measured {
    double value = 0.0;
    double std = 0.0;
};

/// One grey image, seen from a measured camera position. The uncertainty of that position enters every place
/// on the plate, but no size.
struct RestImage {
    cv::Mat grey;                 ///< CV_8UC1, of the camera's width and height
    CameraParameters camera;      ///< geometry, blur and noise
    Eigen::Vector2d axis_mm;      ///< the camera's position: s along the stage axis and y
    Eigen::Vector2d axis_std_mm;  ///< standard deviation of axis_mm
    /// Image point of the fiducial from which the position was determined.
    Eigen::Vector2d anchor_px = Eigen::Vector2d::Zero();
};

/// Where to look for a printed feature, and what counts as found.
struct SearchOptions {
    double margin_mm = 0.06;  ///< largest distance of the feature from its nominal place
    /// 1 - ink / paper reflectance; negative: brighter than its surroundings.
    double expected_contrast = 0.889;
    /// With less than this fraction of the expected contrast the feature counts as absent.
    double least_contrast = 0.35;
    /// Standard uncertainty of each edge as a whole from its unknown shape. The default holds for rendered
    /// edges; a real lens and real ink need more.
    double edge_allowance_um = 0.001;
};

/// How well the model of an edge fits the image.
struct EdgeQuality {
    double contrast = 0.0;  ///< 1 - inside / outside grey level
    double blur_px = 0.0;   ///< fitted optical blur (standard deviation, without the pixel's own area)
    int sections = 0;       ///< number of sections of the outline
    int sections_used = 0;  ///< sections that were not left out as hidden or damaged
    /// r.m.s. of the residuals over their expectation; above 1 it widened the uncertainty.
    double excess = 1.0;
};

/// The projection around one image point, linearised: an error of second order in the distance from it.
struct LocalPicture {
    Eigen::Matrix2d plate_by_image;  ///< mm per px
    Eigen::Matrix2d image_by_plate;  ///< px per mm
    double mm_per_px;                ///< geometric mean over all directions

    /// Length on the plate, mm, of a step of one px along a direction of the image, a unit vector.
    double mm_per_px_along(const Eigen::Vector2d& direction) const {
        return (plate_by_image * direction).norm();
    }
    /// Length in the image, px, of a step of one mm along a direction of the plate, a unit vector.
    double px_per_mm_along(const Eigen::Vector2d& direction) const {
        return (image_by_plate * direction).norm();
    }
};

LocalPicture picture_around(const RestImage& image, const Eigen::Vector2d& image_px);

/// Standard uncertainty, um, from linearising the projection for a thing that extends half_extent_px from a
/// point: the largest second-order term of the back projection within it, taken as uniformly distributed from
/// - to +. Zero for a camera that looks straight down.
double bend_std_um(const RestImage& image, const Eigen::Vector2d& image_px,
                   const Eigen::Vector2d& half_extent_px);

/// Standard deviations along plate x and y, um, of an image point with this covariance; the camera position's
/// uncertainty is not included.
Eigen::Vector2d plate_std_um(const LocalPicture& picture, const Eigen::Matrix2d& covariance_px2);

/// Standard uncertainty, um, of the length between two image points that comes from the camera's calibration.
double calibration_std_um(const RestImage& image, const Eigen::Vector2d& from_px,
                          const Eigen::Vector2d& to_px);

/// Covariance, mm^2, of an image point's place on the plate that comes from the camera's position, and from
/// its calibration between the fiducial and this point.
Eigen::Matrix2d around_covariance_mm2(const RestImage& image, const Eigen::Vector2d& image_px);

/// An image point on the plate: x and y, um, with the uncertainty from its own covariance, from
/// around_covariance_mm2() and from `extra_um`.
std::array<Measured, 2> place_um(const RestImage& image, const Eigen::Vector2d& image_px,
                                 const Eigen::Matrix2d& covariance_px2, double extra_um);

/// Image point in px of a plate point in mm.
inline Eigen::Vector2d to_image(const RestImage& image, const Eigen::Vector2d& plate_mm) {
    return project(image.camera.geometry, plate_mm - Eigen::Vector2d(0.0, image.axis_mm.y()),
                   image.axis_mm.x());
}

/// Plate point in mm of an image point in px.
inline Eigen::Vector2d to_plate(const RestImage& image, const Eigen::Vector2d& image_px) {
    return back_project(image.camera.geometry, image_px, image.axis_mm.x()) +
           Eigen::Vector2d(0.0, image.axis_mm.y());
}

}  // namespace fidservo::vision
