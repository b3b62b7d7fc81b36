// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// An image taken at rest with all that is known of how it came about, and how what is measured in it is
// stated: a value with its standard uncertainty.

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
/// on the plate, and no size.
struct RestImage {
    cv::Mat grey;                                         ///< CV_8UC1, of the camera's width and height
    CameraParameters camera;                              ///< geometry, blur and noise
    Eigen::Vector2d axis_mm;                              ///< camera position: (s, y)
    Eigen::Vector2d axis_std_mm;                          ///< one standard deviation of it
    Eigen::Vector2d anchor_px = Eigen::Vector2d::Zero();  ///< where the fiducial was seen that told it
};

/// Where to look for a printed feature and what counts as finding it.
struct SearchOptions {
    double margin_mm = 0.06;  ///< the feature lies this far from its nominal place at most
    double expected_contrast =
        0.889;                     ///< 1 - ink / paper reflectance; negative: brighter than its surroundings
    double least_contrast = 0.35;  ///< less than this part of the expected contrast: not there
    /// What is not known of the edge's shape, 1 sigma, for each edge as a whole; the default is what rendered
    /// edges leave. A real lens and ink deserve more.
    double edge_allowance_um = 0.001;
};

/// How well the model of an edge met the image.
struct EdgeQuality {
    double contrast = 0.0;  ///< 1 - inside / outside grey level
    double blur_px = 0.0;   ///< optical blur found (standard deviation, without the pixel's own area)
    int sections = 0;       ///< pieces of the outline that were looked at
    int sections_used = 0;  ///< of these, not set aside as hidden or damaged
    double excess =
        1.0;  ///< r.m.s. of the residuals over their expectation; above 1 it widened the uncertainty
};

/// The picture around one of its points, as a linear map: straight things there stay straight to second order
/// of their size.
struct LocalPicture {
    Eigen::Matrix2d plate_by_image;  ///< mm per px
    Eigen::Matrix2d image_by_plate;  ///< px per mm
    double mm_per_px;                ///< geometric mean of all directions

    /// Length on the plate of a step of one px along a direction of the image, a unit vector.
    double mm_per_px_along(const Eigen::Vector2d& direction) const {
        return (plate_by_image * direction).norm();
    }
    /// The same for a direction of the plate.
    double px_per_mm_along(const Eigen::Vector2d& direction) const {
        return (image_by_plate * direction).norm();
    }
};

LocalPicture picture_around(const RestImage& image, const Eigen::Vector2d& image_px);

/// What the linear map leaves of a thing that reaches half_extent_px from a point, um, as a standard
/// deviation: the largest second-order term of the back projection within, taken as equally probable from -
/// to +. Zero for a camera that looks straight down.
double bend_std_um(const RestImage& image, const Eigen::Vector2d& image_px,
                   const Eigen::Vector2d& half_extent_px);

/// Standard deviations along plate x and y, um, of an image point whose covariance is known, without the
/// camera's own position.
Eigen::Vector2d plate_std_um(const LocalPicture& picture, const Eigen::Matrix2d& covariance_px2);

/// What the camera's calibration leaves of the length from one image point to another: standard deviation,
/// um.
double calibration_std_um(const RestImage& image, const Eigen::Vector2d& from_px,
                          const Eigen::Vector2d& to_px);

/// What the camera's position, and its calibration from the fiducial to here, leave of an image point's place
/// on the plate, mm^2.
Eigen::Matrix2d around_covariance_mm2(const RestImage& image, const Eigen::Vector2d& image_px);

/// An image point on the plate: x and y, um, with what its covariance, around_covariance_mm2() and `extra_um`
/// leave.
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
