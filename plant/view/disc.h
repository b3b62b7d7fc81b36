// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A round dot after blur and pixel integration.
#include <span>
#include <vector>

#include <Eigen/Core>

namespace fidservo::plant::view {

/// The coverage of pixels by a disc of any size, also one that is small against the blur. It depends on the
/// radius only, and is tabulated:
///     G(r) = int_{-R}^{R} N_sigma(r - x) erf(sqrt(R^2 - x^2) / (sigma sqrt 2)) dx,
/// sigma = blur_with_pixel_px(blur).
class Disc {
  public:
    /// diameter_px > 0; sigma_px > 0 is the blur with the pixel.
    Disc(double diameter_px, double sigma_px);

    /// Half the size in px of the image box outside which nothing is covered.
    Eigen::Vector2d half_extent_px() const { return Eigen::Vector2d::Constant(outer_px_); }

    /// Coverage of the pixels (du, dv), (du + 1, dv), ... relative to the disc's centre, in px.
    void cover(double du, double dv, std::span<float> coverage) const;

    /// Coverage of the pixels at places (du, dv) relative to the disc's centre, in px.
    void cover_at(std::span<const double> du, std::span<const double> dv, std::span<float> coverage) const;

  private:
    float covered(double r_squared) const;

    double inner_px_;  ///< within this radius the coverage is 1
    double outer_px_;  ///< beyond this radius it is 0
    std::vector<float> table_;
};

}  // namespace fidservo::plant::view
