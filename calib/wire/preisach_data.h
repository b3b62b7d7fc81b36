// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What identifications of hysteresis are made from, and what can be said of it before any fit.

#include "core/result.h"

#include <cstddef>
#include <span>
#include <vector>

namespace fidservo::calib {

/// Simultaneous samples in the order of time. A static model: the rate does not matter.
struct HysteresisTrace {
    std::vector<double> input;
    std::vector<double> output;
};

inline constexpr std::size_t least_hysteresis_samples = 50;

/// Refuses, as Reason::not_identifiable, data that are too short, not finite or do not move, and numbers of
/// nodes outside 3..80.
Status check_hysteresis_trace(const HysteresisTrace& trace, std::size_t nodes);

/// +1 if the output rises with the input, -1 if it falls.
double direction_of(const HysteresisTrace& trace);

/// The input with reversals below a size ignored, so that noise does not write into the memory: between the
/// reversals that remain, the monotone course nearest to it (isotonic regression, which neither lags nor
/// narrows a loop).
std::vector<double> without_small_reversals(std::span<const double> input, double least_reversal);

/// What must be ignored of an input's reversals: eight standard deviations of its noise, as its fourth
/// differences show it, and one step of its resolution.
double noise_reversal(std::span<const double> input);

/// The smallest step between different values: a sensor's resolution; tiny for one that has no steps.
double smallest_step(std::span<const double> values);

/// The first sample at which the memory is known: where the input first stands at an end of its range, within
/// 1 %.
std::size_t first_known_memory(std::span<const double> input);

/// Integrated autocorrelation of residuals in samples, >= 1: n correlated samples are worth n over this.
double correlation_length(std::span<const double> residual);

}  // namespace fidservo::calib
