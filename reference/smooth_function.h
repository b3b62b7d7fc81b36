// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A smooth function of one quantity that nobody has a formula for: a draw from a Gaussian process, as a sum
// of cosines whose wave numbers are drawn from the spectrum of its kernel.
//
//     f(x) = size (sum_i a cos(k_i u + p_i) - (c + d u)),     u = (x - middle) / half range
//
// The straight line is the one that fits the sum best, so that what is left is neither an offset nor a slope.
// Source: Rahimi, Recht, "Random features for large-scale kernel machines", NIPS 2007.
#include <array>
#include <cstddef>

namespace fidservo::reference {

inline constexpr std::size_t smooth_waves = 12;

struct SmoothFunction {
    double size = 0.0;              ///< r.m.s. over the range, in the unit of what it acts on; 0: none
    double low = -1.0, high = 1.0;  ///< the range that it was scaled over; it goes on beyond it
    double amplitude = 0.0;         ///< a, with which the sum has an r.m.s. of 1 once the line is taken off
    double offset = 0.0, slope = 0.0;  ///< c, d
    std::array<double, smooth_waves> wave_numbers{};
    std::array<double, smooth_waves> phases_rad{};

    double operator()(double x) const;
};

/// The sum of cosines without its best straight line, scaled to the r.m.s. given.
/// @param size  in the unit of what it acts on
SmoothFunction smooth_function(double size, double low, double high,
                               const std::array<double, smooth_waves>& wave_numbers,
                               const std::array<double, smooth_waves>& phases_rad);

}  // namespace fidservo::reference
