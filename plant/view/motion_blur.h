// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Motion blur: the camera's motion during the exposure as a convolution along u.
#include <span>
#include <vector>

namespace fidservo::plant::view {

/// Motion of less than this widens an edge by less than 3e-5 of its width.
inline constexpr double invisible_motion_px = 0.02;

/// The time average of a position over the exposure, from samples evenly spaced over it, both ends included,
/// with linear interpolation.
double mean_position(std::span<const double> samples);

/// Weights of the average over shifted copies of an image row. The shifts follow the motion, at steps of at
/// most half a pixel (fine against any blur), and a copy shifted by a fraction of a pixel is interpolated
/// from eight neighbours (Lagrange), which holds a blurred edge in even motion to 0.2 % of its contrast.
class MotionKernel {
  public:
    /// @param shifts_px  of the image relative to where it is painted, evenly spaced over the exposure, both
    /// ends included. A motion too small to be seen gives an identity.
    explicit MotionKernel(std::span<const double> shifts_px);

    /// Whether there is no motion, so that apply() need not be called.
    bool is_identity() const { return taps_.empty(); }
    /// How many pixels to either side have an influence.
    int reach() const { return reach_; }

    /// blurred[i] = sum over k = 0 .. 2 reach of tap[k] sharp[i + k]: sharp begins reach() pixels before
    /// blurred and ends reach() after it.
    void apply(std::span<const float> sharp, std::span<float> blurred) const;

  private:
    int reach_ = 0;
    std::vector<float> taps_;  ///< the weights; their number is a multiple of 4
};

}  // namespace fidservo::plant::view
