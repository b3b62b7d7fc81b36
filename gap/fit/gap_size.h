// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How large a gap is, and how much of it an explanation removes.
//
// Of a signal: r.m.s. error over all values of held-out windows, against its floor. Of a rig: r.m.s. of these
// ratios over the signals, where a signal below its floor (a carriage at rest within its count) counts as at
// it. What is removed is counted in what exceeds the floor:
//
//     removed = 1 - (after^2 - 1) / (before^2 - 1),  clipped to 0 .. 1
#include "gap/diagnosis.h"
#include "gap/evidence.h"

#include <array>
#include <span>
#include <utility>
#include <vector>

namespace fidservo::gap {

/// A remainder below this is not worth a finding, whatever its significance.
inline constexpr double least_floors = 1.1;

/// The discrepancy is 0 where what is left is below least_floors of what noise leaves.
std::vector<SignalGap> signal_gaps(const Evidence& evidence, std::span<const double> before,
                                   std::span<const double> after);

TotalGap total_gap(std::span<const SignalGap> signals);

/// 95 % interval of what is removed, by drawing the windows again in blocks of three (bootstrap, 400 draws).
std::pair<double, double> removed_interval(const Evidence& evidence, std::span<const double> before,
                                           std::span<const double> after);

/// How far a signal's windows typically are from its floor, sqrt(exp(mean log(1 + S_w)) - 1); 1 at least, and
/// of a signal without windows. A window in which the carriage let go that should have held weighs no more
/// than others here.
std::array<double, signal_count> typical_floors(std::span<const Window> windows,
                                                std::span<const double> mean_squares);

}  // namespace fidservo::gap
