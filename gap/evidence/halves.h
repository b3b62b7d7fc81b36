// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What is fitted and what is judged.
#include "gap/evidence.h"

#include <cstdint>
#include <span>
#include <vector>

namespace fidservo::gap {

/// Which half of the windows a window belongs to. Hypotheses are fitted on one half and judged on the other,
/// both ways. Of a signal, the runs of one experiment that show it go to different halves; where one run
/// shows it, stretches of four windows do.
std::vector<std::uint8_t> halves(const Evidence& evidence);

/// The same by stretches of every run: for what has a value of its own in each run.
std::vector<std::uint8_t> halves_of_each_run(const Evidence& evidence);

/// Windows from which a fit learns most, of those eligible: of each signal at most `most`, half of them
/// of all sizes of error above the median (the largest ones are beyond what a fit can follow at first), the
/// others evenly spread in time.
/// @param mean_squares  of all windows under what is known already; NaN: has no values
Wanted instructive(std::span<const Window> windows, const Wanted& eligible,
                   std::span<const double> mean_squares, std::size_t most);

}  // namespace fidservo::gap
