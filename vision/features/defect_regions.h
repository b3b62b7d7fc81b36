// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// From a difference image to defects: which pixels differ beyond chance, and what they form.
#include <vector>

#include <opencv2/core/mat.hpp>

namespace fidservo::vision {

/// The difference of an image from what it should read, and what of it means nothing. All CV_32FC1, grey
/// levels.
struct DifferenceImage {
    cv::Mat difference;  ///< image - expected; zero where nothing is compared
    cv::Mat variance;    ///< of the noise in it
    cv::Mat allowance;   ///< systematic differences up to this size are no defects
};

struct SignificanceMap {
    cv::Mat
        significance;  ///< CV_32FC1: greatest over the scales, in standard deviations beyond the allowance
    double threshold;
};

/// Tests every pixel at every scale F (Gaussians of 1, 2 and 4 px):
///     z = (|F * D| - F * allowance) / sqrt(F^2 * variance)
/// @param false_alarms  probability that any z of `tested_pixels` exceeds the threshold by chance
/// (Bonferroni)
SignificanceMap significance_of(const DifferenceImage& image, double tested_pixels, double false_alarms);

/// A connected set of significant pixels, px.
struct DefectRegion {
    cv::Point2d centre_px;  ///< weighted by the difference
    double area_px2;        ///< of the pixels above half of the greatest difference nearby
    double length_px;       ///< of the smallest rectangle around them
    double greatest_grey;   ///< greatest difference, with sign (positive: brighter than it should be)
    double significance;    ///< greatest
};

/// @param least_grey  weaker differences are left out
/// @param join_px     pieces nearer than this are one region
std::vector<DefectRegion> defect_regions(const DifferenceImage& image, const SignificanceMap& map,
                                         double least_grey, double join_px);

}  // namespace fidservo::vision
