// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The loss of predictions in each window, and the comparison of two hypotheses by their losses.
//
// A window w with the mean square error S_w, in floors squared, has the loss
//
//     l_w = 1/2 log(1 + S_w)
//
// for each independent value: the negative logarithm of a normal density whose unknown standard deviation is
// at least the floor. Unlike a sum of squares, it does not let a window that is wrong by a hundred floors
// outvote those that the hypothesis explains.
#include "gap/evidence.h"

#include <cstddef>
#include <span>
#include <vector>

namespace fidservo::gap {

/// Mean square, in floors squared, from which on a window is off.
inline constexpr double off_square = 2.0;

/// Neighbouring windows whose errors are correlated through slow states.
inline constexpr std::size_t windows_in_correlation = 3;

/// S_w of each window; NaN where no value counts, and everywhere for errors of a hypothesis that the plant
/// refused.
std::vector<double> mean_squares(std::span<const Window> windows, const Errors& errors);

/// The loss l_w of a window with the mean square S_w.
double window_loss(double mean_square);

/// Sum of the windows' losses; windows without values (NaN) do not count.
double total_loss(std::span<const double> mean_squares);

/// Total loss of the counted windows; infinite for errors of a hypothesis that the plant refused.
double total_loss(std::span<const Window> windows, const Wanted& counted, const Errors& errors);

/// The loss that errors save compared with a base's mean squares, in the counted windows that both predict;
/// minus infinity if the simulator rejected the hypothesis of the errors.
double gained(std::span<const Window> windows, const Wanted& counted, std::span<const double> base_squares,
              const Errors& errors);

/// gained() with the mean squares of both.
double gained(const Wanted& counted, std::span<const double> base_squares, std::span<const double> squares);

/// How a second hypothesis compares with a first one on the same windows.
struct Comparison {
    double gain = 0.0;  ///< sum over windows of the loss that the second one saves
    /// gain over its standard deviation, estimated from the scatter of the gains of blocks: three
    /// neighbouring windows of a signal in a run, or one frame. 0 where fewer than two blocks differ.
    double significance = 0.0;
    int blocks = 0;  ///< number of blocks in which the two differ
};

Comparison compare(std::span<const Window> windows, std::span<const double> first,
                   std::span<const double> second);

/// Least held-out loss that a cause has to save, whatever its significance. Dividing the error of one window
/// far above its floor by 1.6 saves as much.
inline constexpr double least_gain = 0.5;

/// The significance that any of `trials` comparisons exceeds by chance with probability `tail` (Bonferroni),
/// by Student's t distribution with blocks - 1 degrees of freedom. Infinite for fewer than four blocks.
double significance_bound(int blocks, int trials, double tail);

}  // namespace fidservo::gap
