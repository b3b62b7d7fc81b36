// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// From a difference image to defects: the pixels whose difference is significant, and the regions that they
// form.
#include <vector>

#include <opencv2/core/mat.hpp>

namespace fidservo::vision {

/// The difference of an image from the expected one, with its noise and its tolerated part. All CV_32FC1,
/// grey levels.
struct DifferenceImage {
    cv::Mat difference;  ///< image - expected; zero where there is no comparison
    cv::Mat variance;    ///< variance of the difference's noise
    cv::Mat allowance;   ///< systematic differences up to this size do not count as defects
};

struct SignificanceMap {
    /// CV_32FC1: the largest over the scales, in standard deviations beyond the allowance.
    cv::Mat significance;
    double threshold;
};

/// Tests every pixel at every scale F (Gaussians of 1, 2 and 4 px):
///     z = (|F * D| - F * allowance) / sqrt(F^2 * variance)
/// @param false_alarms  probability that any z among `tested_pixels` exceeds the threshold by chance
/// (Bonferroni)
SignificanceMap significance_of(const DifferenceImage& image, double tested_pixels, double false_alarms);

/// A connected set of significant pixels, px.
struct DefectRegion {
    cv::Point2d centre_px;  ///< weighted by the difference
    double area_px2;        ///< area of the pixels with more than half of the largest difference nearby
    double length_px;       ///< length of the smallest rectangle around those pixels
    double greatest_grey;   ///< largest difference, with its sign (positive: brighter than expected)
    double significance;    ///< the largest significance of its pixels
};

/// @param least_grey  smaller differences are left out
/// @param join_px     pieces nearer to each other than this are one region
std::vector<DefectRegion> defect_regions(const DifferenceImage& image, const SignificanceMap& map,
                                         double least_grey, double join_px);

}  // namespace fidservo::vision
