// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Collects the pixels along an outline, section by section, each with its distance from the outline.
#include "vision/features/subpixel_edge.h"

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

namespace fidservo::vision {

using EdgeSamples = std::vector<EdgeSample>;

/// Distances from the outline, inwards and outwards, up to which pixels are taken.
struct Reach {
    double in_px;
    double out_px;
};

/// The surroundings of a circle in equal sectors, the first one centred at angle 0; t = distance from the
/// centre minus radius.
std::vector<EdgeSamples> samples_of_ring(const cv::Mat& grey, const Eigen::Vector2d& centre_px,
                                         double radius_px, const Reach& reach, int sectors);

/// The surroundings of a straight segment in equal stretches from `from_px` to `to_px`; t = distance along
/// `outward`, the segment's unit normal.
std::vector<EdgeSamples> samples_of_band(const cv::Mat& grey, const Eigen::Vector2d& from_px,
                                         const Eigen::Vector2d& to_px, const Eigen::Vector2d& outward,
                                         const Reach& reach, int stretches);

/// Mean grey in bins of 1 px: bin k holds low_px + k <= t < low_px + k + 1. Bins without a pixel repeat their
/// neighbour.
struct BinnedProfile {
    double low_px;
    std::vector<double> grey;
};
BinnedProfile binned_profile(std::span<const EdgeSample> samples);

/// The position of the largest step in a profile, to about a pixel: the mean of the 3 px above it less the
/// mean of the 3 px below. Only steps of the given sign (+1: brighter outwards, -1: darker outwards) of at
/// least `least_grey` count.
std::optional<double> coarse_step_px(std::span<const EdgeSample> samples, double sign, double least_grey);

}  // namespace fidservo::vision
