// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Where a tag is, as precisely as its pixels allow, from all edges of its code.
#include "core/camera/camera_geometry.h"
#include "core/detection.h"
#include "core/result.h"
#include "vision/grey_noise.h"

#include <array>
#include <optional>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

namespace fidservo::vision {

/// Of the eight coordinates of a tag's corners, px^2.
using CornerCovariance = Eigen::Matrix<double, 8, 8>;

/// RefinedTag::explained below which a tag that could be refined is yet not measured by.
inline constexpr double enough_to_measure = 0.7;

/// A tag that was measured.
struct RefinedTag {
    TagDetection detection;  ///< with the refined corners
    CornerCovariance
        covariance_px2;  ///< of (u0, v0, u1, v1, ...): corners share edges, so it is not diagonal
    Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();              ///< image of the tag's centre
    Eigen::Matrix2d centre_covariance_px2 = Eigen::Matrix2d::Zero();  ///< of the centre
    double explained = 1.0;  ///< share of the edges' length that looks like this tag; the rest was left out
    double blur_px = 0.0;    ///< standard deviation of the edges' profiles, optics and pixel together
    double ink_spread_px = 0.0;  ///< by which every black edge reaches farther out than the code says
    double misfit = 1.0;  ///< mean square of what the model leaves, in variances of the noise: 1 if it fits
    bool fits =
        true;  ///< whether that can be noise alone, at 1 %; if not, covariances are sandwich estimates
    /// Whether perspective and distortion of the picture are those of the camera in the options; if not, all
    /// eight coordinates of the corners were measured.
    bool camera_known = false;
};

/// What is known of the picture beforehand.
struct RefinementOptions {
    /// A calibrated camera: tilt and distortion of the tag's picture are taken from it. Without one the
    /// perspective is fitted too, which costs precision (1.4 times the standard deviation); so it is where a
    /// tag fits a free perspective but not the camera's.
    std::optional<CameraGeometry> camera;
    GreyNoise noise{white_grey / 10000.0, 0.1, 0.0};  ///< of the camera
    /// Of the picture during the exposure. Zero: unknown; the edges' unequal blurs tell it.
    Eigen::Vector2d motion_px = Eigen::Vector2d::Zero();
    /// Standard deviation of the edges' profiles to begin with: a good guess saves a step or two.
    double blur_px = 1.0;
};

/// Weighted least squares of a picture of the tag against the raw pixels along all edges of its code:
/// position, rotation, scale (without a calibrated camera also perspective), blur, ink spread, and planes
/// of light for black and for white. Weights are the camera's own noise at the modelled grey level. Stretches
/// of edge that do not look like the tag (covered, scratched, glaring) are left out. Covariances follow from
/// the Fisher information, and are widened to a sandwich estimate where the picture differs from the model by
/// more than noise.
/// Valid for tags of 24 px a side on, found to within two pixels or a quarter of a cell.
/// Fails with Reason::occluded if too little of the tag can be seen, if it leaves the image, or if the
/// corners would move by more than a cell's width.
Result<RefinedTag> refine_tag(const cv::Mat& image, const TagDetection& found,
                              const RefinementOptions& options = {});

/// A tag of which only the corners were measured, by whatever means.
RefinedTag tag_of_corners(const TagDetection& corners, const CornerCovariance& covariance_px2);

/// The tag as found, with the uncertainty of the library's corners (0.2 px a coordinate against rendered
/// tags) in place of a measured one: for tags too small or too hidden to be refined. `explained` is 0.
RefinedTag unrefined(const TagDetection& found);

/// Image of the tag's centre as its corners tell it (where the diagonals cross), px.
Eigen::Vector2d centre_px(const TagDetection& tag);

}  // namespace fidservo::vision
