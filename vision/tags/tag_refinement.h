// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Measures the position of a tag as precisely as its pixels allow, from all edges of its code.
#include "core/camera/camera_geometry.h"
#include "core/detection.h"
#include "core/result.h"
#include "vision/grey_noise.h"

#include <array>
#include <optional>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

namespace fidservo::vision {

/// Covariance of the eight coordinates of a tag's corners, px^2.
using CornerCovariance = Eigen::Matrix<double, 8, 8>;

/// Least RefinedTag::explained of a tag that is used for measuring.
inline constexpr double enough_to_measure = 0.7;

/// A tag that was measured.
struct RefinedTag {
    TagDetection detection;  ///< with the refined corners
    CornerCovariance
        covariance_px2;  ///< of (u0, v0, u1, v1, ...): corners share edges, so it is not diagonal
    Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();              ///< image of the tag's centre
    Eigen::Matrix2d centre_covariance_px2 = Eigen::Matrix2d::Zero();  ///< of the centre
    /// Fraction of the edges' length that looks like this tag; the rest was left out.
    double explained = 1.0;
    double blur_px = 0.0;  ///< standard deviation of the edges' profiles, from optics and pixel together
    double ink_spread_px = 0.0;  ///< distance by which every black edge extends farther outwards than nominal
    double misfit = 1.0;  ///< mean square of the residuals in variances of the noise: 1 for a perfect model
    /// Whether the misfit can be due to noise alone, at a level of 1 %; if not, covariances are sandwich
    /// estimates.
    bool fits = true;
    /// Whether the camera of the options gave perspective and distortion; if not, all eight coordinates of
    /// the corners were fitted.
    bool camera_known = false;
};

/// Prior knowledge of camera and motion.
struct RefinementOptions {
    /// A calibrated camera, whose tilt and distortion determine the tag's perspective. Without one the
    /// perspective is fitted, too, which increases the standard deviation of the position to 1.4 times. The
    /// same happens if a tag fits a free perspective but not the camera's.
    std::optional<CameraGeometry> camera;
    GreyNoise noise{white_grey / 10000.0, 0.1, 0.0};  ///< of the camera
    /// The tag's motion in the image during the exposure. Zero: unknown; it is then fitted as a different
    /// blur across the two directions of edges.
    Eigen::Vector2d motion_px = Eigen::Vector2d::Zero();
    /// Initial value for the standard deviation of the edges' profiles: a good one saves an iteration or two.
    double blur_px = 1.0;
};

/// Weighted least-squares fit of a modelled picture of the tag to the raw pixels along all edges of its code.
/// The parameters are position, rotation, scale (without a calibrated camera also perspective), the blur and
/// its shape, ink spread, the levels of black and white, and the variation of light over the tag. Weights are
/// the camera's own noise at the modelled grey level. Stretches of edge that do not look like the tag
/// (covered, scratched, glaring) are left out. Covariances follow from the Fisher information, and are
/// widened to a sandwich estimate where the picture differs from the model by more than noise. Valid for tags
/// with sides of at least 24 px, whose corners are known to within two pixels or a quarter of a cell. Fails
/// with Reason::occluded if too little of the tag can be seen, if it leaves the image, or if the corners
/// would move by more than a cell's width.
Result<RefinedTag> refine_tag(const cv::Mat& image, const TagDetection& found,
                              const RefinementOptions& options = {});

/// A tag of which only the corners were measured, by any means.
RefinedTag tag_of_corners(const TagDetection& corners, const CornerCovariance& covariance_px2);

/// The tag as detected, with the uncertainty of the library's corners (0.2 px per coordinate on rendered
/// tags) in place of an estimated one: for tags too small or too hidden to be refined. `explained` is 0.
RefinedTag unrefined(const TagDetection& found);

/// Image of the tag's centre, px: the intersection of the diagonals between its corners.
Eigen::Vector2d centre_px(const TagDetection& tag);

}  // namespace fidservo::vision
