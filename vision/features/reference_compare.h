// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Comparison with a reference image: what is there that should not be, and what is missing.
#include "core/result.h"
#include "vision/features/rest_image.h"

#include <vector>

namespace fidservo::vision {

/// What the view should look like: an image of a good part, or one drawn from the nominal plate.
struct ReferenceImage {
    cv::Mat grey;             ///< CV_8UC1, same size and camera as the image compared with it
    Eigen::Vector2d axis_mm;  ///< plate point under the optical axis
    bool noise_free = false;  ///< drawn, not taken
};

struct CompareOptions {
    double false_alarms_per_view =
        1e-3;                ///< probability that a good view yields any defect, in the worst case
    double search_px = 6.0;  ///< the two images are out of register by this at most, beyond their positions
    double edge_allowance_um =
        0.4;  ///< an edge may lie this far from where the reference has it, after alignment
    double gain_allowance = 0.01;  ///< light may differ by this part after its fit (uneven beyond a plane)
    double least_contrast = 0.03;  ///< weaker differences, as a part of the paper's level, are no defects
    double join_um = 24.0;         ///< pieces nearer than this are one defect
};

enum class DefectSign { additional_ink, missing_ink };

struct Defect {
    Eigen::Vector2d centre_mm;      ///< plate frame, weighted by the difference
    double area_um2;                ///< above half of its greatest difference
    double equivalent_diameter_um;  ///< of the disc of that area
    double length_um;               ///< of the smallest rectangle around it
    double width_um;                ///< area / length: the mean width of what is long and thin
    DefectSign sign;                ///< of the greatest difference
    double contrast;                ///< greatest difference, as a part of the paper's level
    double significance;            ///< greatest difference beyond the allowances, in standard deviations
};

struct Comparison {
    std::vector<Defect> defects;         ///< most significant first
    double threshold;                    ///< significance from which a difference counts
    Eigen::Vector2d misregistration_px;  ///< by how much the image is shifted beyond what the positions say
    double gain;                         ///< mean light of the image over that of the reference
    double compared_fraction;            ///< part of the image that the reference covers
};

/// Aligns the reference (known positions, then robust least squares in shift, gain, offset and light
/// gradient), and tests the difference, smoothed at several scales, in every pixel against noise and
/// allowances:
///     |F * (I - R)|  >  k sqrt(F^2 * var) + F * (|grad R| a_edge + R a_gain)
/// with k from the family-wise false alarm rate over all pixels and scales (Bonferroni; normal law).
/// Fails with not_identifiable (less than a quarter of the view is covered by the reference) or
/// no_convergence (the images cannot be brought into register: this is not the same place).
Result<Comparison> compare_with_reference(const RestImage& image, const ReferenceImage& reference,
                                          const CompareOptions& options = {});

}  // namespace fidservo::vision
