// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The coverage of a camera's pixels by a region, exact to rounding.
//
// The optics blur with a normal distribution, motion during the exposure with a box along u, and a pixel
// averages over its square: the kernel is separable, k(x, y) = kx(x) ky(y). With K(z) = integral of kx up to
// z, Green's theorem turns the coverage of pixel (u, v) into an integral along the region's boundary,
//
//     c(u, v) = integral over the region of k(x - u, y - v) dx dy = closed integral of K(x - u) ky(y - v) dy,
//
// which Gauss's rule gives to eight digits, for a boundary in any direction.
#include <vector>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

namespace fidservo::precision {

struct Blur {
    double sigma_px = 0.8;                 ///< of the optics, greater than 0
    double motion_px = 0.0;                ///< along u during the exposure
    double halo_share = 0.0;               ///< fraction of the light in a second normal distribution
    double halo_sigma_px = 0.8;            ///< its standard deviation
    double standard_deviation_px() const;  ///< of the optics alone
};

/// One boundary edge, straight in the image: going from `from` to `to` with u to the right and v down, the
/// region is on the right hand, if `weight` is 1; -1: on the left.
struct BoundaryEdge {
    Eigen::Vector2d from_px, to_px;
    double weight = 1.0;
};

/// Coverage (0..1) of every pixel of an image. The edges must close; the boundary may leave the image.
cv::Mat1d coverage(const std::vector<BoundaryEdge>& edges, const Blur& blur, cv::Size size_px);

/// Edges of a polygon whose corners are listed clockwise as seen in the image.
std::vector<BoundaryEdge> edges_of(const std::vector<Eigen::Vector2d>& polygon_px);

}  // namespace fidservo::precision
