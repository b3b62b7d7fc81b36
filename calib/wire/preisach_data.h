// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The data for the identification of hysteresis, and their properties before any fit.

#include "core/result.h"

#include <cstddef>
#include <span>
#include <vector>

namespace fidservo::calib {

/// Simultaneous samples of input and output in the order of time. The model is rate-independent, so the times
/// do not matter.
struct HysteresisTrace {
    std::vector<double> input;
    std::vector<double> output;
};

inline constexpr std::size_t least_hysteresis_samples = 50;

/// Fails with Reason::not_identifiable for data that are too short, not finite or constant, and for numbers
/// of nodes outside 3..80.
Status check_hysteresis_trace(const HysteresisTrace& trace, std::size_t nodes);

/// +1 if the output rises with the input, -1 if it falls.
double direction_of(const HysteresisTrace& trace);

/// The input without reversals smaller than `least_reversal`, so that noise does not enter the hysteresis
/// memory: between the remaining reversals it is the nearest monotone function (isotonic regression, which
/// neither lags nor narrows a loop).
std::vector<double> without_small_reversals(std::span<const double> input, double least_reversal);

/// The size below which an input's reversals count as noise: eight standard deviations of its noise,
/// estimated from fourth differences, plus one step of its resolution.
double noise_reversal(std::span<const double> input);

/// The smallest difference between distinct values: a sensor's resolution; tiny for a continuous one.
double smallest_step(std::span<const double> values);

/// The first sample at which the hysteresis memory is known: where the input is first at an end of its range,
/// within 1 %.
std::size_t first_known_memory(std::span<const double> input);

/// Integrated autocorrelation L of residuals, in samples, at least 1: n correlated samples are worth n / L
/// independent ones.
double correlation_length(std::span<const double> residual);

}  // namespace fidservo::calib
