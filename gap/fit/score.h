// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How well predictions do, window by window, and whether one hypothesis does better than another.
//
// A window w of S_w, the mean square of its errors in floors, has the loss
//
//     l_w = 1/2 log(1 + S_w)
//
// per independent value: the negative logarithm of a normal density of unknown scale whose least scale is the
// floor. So a window that is wrong by a hundred floors does not outvote those that the hypothesis explains,
// as it would with squares.
#include "gap/evidence.h"

#include <span>
#include <vector>

namespace fidservo::gap {

/// S_w; NaN where no value counts, and everywhere for errors of a hypothesis that the plant refused.
std::vector<double> mean_squares(std::span<const Window> windows, const Errors& errors);

/// l_w of S_w.
double window_loss(double mean_square);

/// Sum of the windows' losses; those without values count nothing.
double total_loss(std::span<const double> mean_squares);

/// Of the windows counted. Infinite for errors of a hypothesis that the plant refused.
double total_loss(std::span<const Window> windows, const Wanted& counted, const Errors& errors);

/// Loss that errors save over mean squares of other ones in the windows counted that both predict; minus
/// infinity where the plant refused it.
double gained(std::span<const Window> windows, const Wanted& counted, std::span<const double> base_squares,
              const Errors& errors);

/// Of two hypotheses on the same windows.
struct Comparison {
    double gain = 0.0;  ///< sum of the losses that the second one saves
    /// gain over its standard deviation, from the scatter of the windows' gains with three neighbouring
    /// windows of a run taken together, frames each by itself; 0 where nothing differs.
    double significance = 0.0;
    int blocks = 0;  ///< of windows in which they differ
};

Comparison compare(std::span<const Window> windows, std::span<const double> first,
                   std::span<const double> second);

/// Least held-out loss that a cause has to save, whatever its significance: what makes the error of a window
/// far above its floor smaller by the factor 1.6.
inline constexpr double least_gain = 0.5;

/// Smallest significance that is no chance, at level `tail` over `trials` comparisons: Student's law with a
/// degree of freedom less than blocks. Infinite for fewer than three blocks.
double significance_bound(int blocks, int trials, double tail);

}  // namespace fidservo::gap
