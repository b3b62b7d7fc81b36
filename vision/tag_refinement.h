#pragma once
// A tag's corners, to a few thousandths of a pixel, from the four edges of its black border.
#include "core/detection.h"
#include "core/failure.h"

#include <array>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

namespace fidservo::vision {

using CornerCovariance = Eigen::Matrix<double, 8, 8>;

/// A tag whose border was measured.
struct RefinedTag {
    TagDetection detection;  ///< with the refined corners
    CornerCovariance
        covariance_px2;      ///< of (u0, v0, u1, v1, ...): corners share edges, so it is not diagonal
    double explained = 1.0;  ///< of the worst edge: share of its length that looks like an edge
    double blur_px = 0.0;    ///< mean standard deviation of the four edges' profiles
};

/// Fits a straight edge to the raw pixels along each side of the border and intersects neighbours.
/// Near the corners the edges are left out, where the blur of one reaches into the other.
/// Valid for borders at least 4 px wide (a side of 32 px) with a quiet zone as wide.
/// Fails with Reason::occluded if an edge cannot be seen for most of its length, leaves the image, if the
/// border is too narrow to be measured, or if the corners would move by more than the border's width.
Result<RefinedTag> refine_tag(const cv::Mat& image, const TagDetection& found);

/// The tag as found, with the uncertainty of the library's corners (0.2 px a coordinate against rendered
/// tags) in place of a measured one: for tags too small or too hidden to be refined. `explained` is 0.
RefinedTag unrefined(const TagDetection& found);

/// Image of the tag's centre (where the diagonals cross), px.
Eigen::Vector2d centre_px(const TagDetection& tag);

/// Covariance of centre_px() in px^2: the mean of the corners, which is the centre up to perspective.
Eigen::Matrix2d centre_covariance_px2(const CornerCovariance& corners);

}  // namespace fidservo::vision
