// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A random smooth function of one quantity: a draw from a Gaussian process, as a sum of cosines whose wave
// numbers are drawn from the spectrum of its kernel.
//
//     f(x) = size (sum_i a cos(k_i u + p_i) - (c + d u)),     u = (x - middle) / half range
//
// The straight line is the one that fits the sum best, so that the function has neither an offset nor a
// slope. Source: Rahimi, Recht, "Random features for large-scale kernel machines", NIPS 2007.
#include <array>
#include <cstddef>

namespace fidservo::reference {

inline constexpr std::size_t smooth_waves = 12;

struct SmoothFunction {
    double size = 0.0;  ///< r.m.s. over the range, in the unit of the quantity it is added to; 0: none
    double low = -1.0, high = 1.0;  ///< the range over which it was scaled; the function continues beyond it
    double amplitude = 0.0;         ///< a, which makes the r.m.s. of the sum without its line 1
    double offset = 0.0, slope = 0.0;  ///< c, d
    std::array<double, smooth_waves> wave_numbers{};
    std::array<double, smooth_waves> phases_rad{};

    double operator()(double x) const;
};

/// The sum of cosines without its best straight line, scaled to an r.m.s. of `size`.
/// @param size  in the unit of the quantity it is added to
SmoothFunction smooth_function(double size, double low, double high,
                               const std::array<double, smooth_waves>& wave_numbers,
                               const std::array<double, smooth_waves>& phases_rad);

}  // namespace fidservo::reference
