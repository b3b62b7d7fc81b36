// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which windows are fitted, and which are judged.
#include "gap/evidence.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace fidservo::gap {

/// Windows in a stretch that belongs to one half as a whole.
inline constexpr std::size_t windows_in_stretch = 4;

/// The half (0 or 1) to which each window belongs: hypotheses are fitted to one half and judged on the other,
/// both ways. The runs of an experiment that contain a signal are assigned to the halves alternately; where
/// only one run contains it, stretches of four windows are.
std::vector<std::uint8_t> halves(const Evidence& evidence);

/// The halves if stretches of four windows alternate in every run: for parameters that have a value of their
/// own in each run.
std::vector<std::uint8_t> halves_of_each_run(const Evidence& evidence);

/// The eligible windows from which a fit learns most, of each signal at most `most`. One half of them covers
/// all sizes of error above the median, since the largest errors are beyond what a fit can follow at first;
/// the other half is evenly spread in time.
/// @param mean_squares  of all windows under what is known already; NaN: has no values
Wanted instructive(std::span<const Window> windows, const Wanted& eligible,
                   std::span<const double> mean_squares, std::size_t most);

}  // namespace fidservo::gap
