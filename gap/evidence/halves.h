// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The division of the windows into two halves for cross-validation.
#include "gap/evidence.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace fidservo::gap {

/// Windows in a stretch that belongs to one half as a whole.
inline constexpr std::size_t windows_in_stretch = 4;

/// The half (0 or 1) to which each window belongs: hypotheses are fitted to one half and judged on the other,
/// both ways. The recordings of one kind of experiment that contain a signal are assigned to the halves
/// alternately; if only one recording contains it, groups of four consecutive windows are.
std::vector<std::uint8_t> halves(const Evidence& evidence);

/// The halves if groups of four consecutive windows alternate within every recording: for parameters with a
/// separate value for each recording.
std::vector<std::uint8_t> halves_of_each_run(const Evidence& evidence);

/// The eligible windows that are most informative for a fit, at most `most` of each signal. One half of them
/// covers all sizes of error above the median, since the largest errors are beyond what a fit can follow at
/// first; the other half is evenly spread in time.
/// @param mean_squares  of all windows under the present explanation; NaN: window without values
Wanted instructive(std::span<const Window> windows, const Wanted& eligible,
                   std::span<const double> mean_squares, std::size_t most);

}  // namespace fidservo::gap
