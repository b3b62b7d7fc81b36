// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The size of a gap, and the fraction of it that an explanation removes.
//
// The gap of a signal is the r.m.s. error over all values of held-out windows, divided by the signal's floor.
// The gap of a rig is the r.m.s. of the signals' gaps, in which a signal below its floor (a carriage at rest
// within a count) counts as 1. The part of a rig's gap that an explanation removes refers to the excess over
// the floor:
//
//     removed = 1 - (after^2 - 1) / (before^2 - 1),  clipped to 0 .. 1
#include "gap/candidates/coupling.h"
#include "gap/diagnosis.h"
#include "gap/evidence.h"

#include <array>
#include <span>
#include <utility>
#include <vector>

namespace fidservo::gap {

/// A gap below this many floors is not worth a finding, however significant it is.
inline constexpr double least_floors = 1.1;

/// Draws of a bootstrap.
inline constexpr int bootstrap_draws = 400;

/// The gap of each signal before and after an explanation, from the mean squares of all windows. The
/// discrepancy is 0 where the r.m.s. error that remains is below least_floors times that expected under the
/// truth.
std::vector<SignalGap> signal_gaps(const Evidence& evidence, std::span<const double> before,
                                   std::span<const double> after);

/// Whether what remains of a signal's error is above its floor.
bool is_left(const SignalGap& signal);

/// The signals for which is_left() is true.
SignalFlags signals_left(std::span<const SignalGap> signals);

TotalGap total_gap(std::span<const SignalGap> signals);

/// 95 % interval of the part of the gap that is removed, by a bootstrap of blocks of three windows (400
/// draws).
std::pair<double, double> removed_interval(const Evidence& evidence, std::span<const double> before,
                                           std::span<const double> after);

/// The typical error of each signal's windows, in floors: sqrt(exp(mean log(1 + S_w)) - 1), at least 1; 1 for
/// signals without windows. Because of the logarithm, a single window in which the carriage broke loose in
/// the recording but not in the prediction does not dominate.
std::array<double, signal_count> typical_floors(std::span<const Window> windows,
                                                std::span<const double> mean_squares);

}  // namespace fidservo::gap
