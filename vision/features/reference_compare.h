// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Comparison with a reference image, to find additional and missing ink.
#include "core/result.h"
#include "vision/features/rest_image.h"

#include <vector>

namespace fidservo::vision {

/// What the view should look like: an image of a good part, or one rendered from the nominal plate.
struct ReferenceImage {
    cv::Mat grey;             ///< CV_8UC1, same size and camera as the image compared with it
    Eigen::Vector2d axis_mm;  ///< plate point under the optical axis
    bool noise_free = false;  ///< rendered, not taken
};

struct CompareOptions {
    double false_alarms_per_view =
        1e-3;                ///< probability that a good view yields any defect, in the worst case
    double search_px = 6.0;  ///< largest misregistration of the two images beyond their known positions
    /// After alignment an edge may be this far from its place in the reference.
    double edge_allowance_um = 0.4;
    /// The light may deviate by this fraction after its fit (unevenness beyond the fitted surface).
    double gain_allowance = 0.01;
    /// Weaker differences, as a fraction of the paper's level, do not count as defects.
    double least_contrast = 0.03;
    double join_um = 24.0;  ///< pieces nearer to each other than this are one defect
};

enum class DefectSign { additional_ink, missing_ink };

struct Defect {
    Eigen::Vector2d centre_mm;      ///< plate frame, weighted by the difference
    double area_um2;                ///< area with more than half of its largest difference
    double equivalent_diameter_um;  ///< diameter of the disc of that area
    double length_um;               ///< length of the smallest rectangle around it
    double width_um;                ///< area / length: the mean width of a long thin defect
    DefectSign sign;                ///< sign of the largest difference
    double contrast;                ///< largest difference, as a fraction of the paper's level
    double significance;            ///< largest difference beyond the allowances, in standard deviations
};

struct Comparison {
    std::vector<Defect> defects;         ///< the most significant first
    double threshold;                    ///< significance above which a difference counts
    Eigen::Vector2d misregistration_px;  ///< shift of the image beyond what the positions predict
    double gain;                         ///< mean light of the image over that of the reference
    double compared_fraction;            ///< fraction of the image that the reference covers
};

/// Aligns the reference (known positions, then robust least squares in shift, gain, offset and light
/// gradient), and tests the difference I - R in every pixel, smoothed by kernels F of several scales, against
/// noise and allowances:
///     |F * (I - R)|  >  k sqrt(F^2 * var) + F * (|grad R| a_edge + R a_gain)
/// with k from the family-wise false alarm rate over all pixels and scales (Bonferroni; normal law). Fails
/// with not_identifiable (less than a quarter of the view is covered by the reference) or no_convergence (the
/// images cannot be registered: they do not show the same place).
Result<Comparison> compare_with_reference(const RestImage& image, const ReferenceImage& reference,
                                          const CompareOptions& options = {});

}  // namespace fidservo::vision
