// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Registers a reference image to an image: shift, gain, offset and uneven light.
#include "core/result.h"
#include "vision/grey_noise.h"

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

namespace fidservo::vision {

/// What the image should be if it shows the same as the reference.
struct AlignedReference {
    cv::Mat expected;          ///< CV_32FC1: light(u, v) R(u + shift) + offset
    cv::Rect valid;            ///< where the reference covers the image
    Eigen::Vector2d shift_px;  ///< place in the reference minus the same point's place in the image
    double gain;               ///< light at the image's middle
};

/// The image moved by a fraction of a pixel: result(u) = image(u + shift). Lanczos kernel of 8 taps; the blur
/// of a lens like the reference rig's leaves too little signal beyond the kernel's band to matter.
cv::Mat shifted(const cv::Mat& image, const Eigen::Vector2d& shift_px);

/// Robust least squares (Tukey's weights) of
///     I(u, v) = (g0 + g1 x + g2 y + g3 x^2 + g4 x y + g5 y^2) R(u + dx, v + dy) + o,     x, y = -1 .. 1
/// on a grid of pixels, first with both images smoothed, then with the original ones.
/// @param grey, reference  CV_32FC1, same size
/// @param start_px   the shift that the camera positions give
/// @param search_px  how far the shift may be from start_px Fails with not_identifiable (too little overlap)
/// or no_convergence (the images do not show the same place).
Result<AlignedReference> align_reference(const cv::Mat& grey, const cv::Mat& reference,
                                         const Eigen::Vector2d& start_px, double search_px,
                                         const GreyNoise& noise);

}  // namespace fidservo::vision
