// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How errors depend on what moved the rig: their mean in bins of velocity, position, temperature and so on.
#include "src/diagnose/report/predictions.h"

#include <cstdint>
#include <string>
#include <vector>

namespace fidservo::diagnose {

/// An error and what it may depend on.
struct Sample {
    float x, before, after;  ///< errors in floors
    std::uint32_t window;
};

/// What a signal's error may depend on.
struct Quantity {
    std::string name;        ///< as gap::Remainder names dependences, so that one finds the other
    std::string axis_label;  ///< with its unit
    std::vector<Sample> samples;
};

/// The quantities that vary in the recordings.
std::vector<Quantity> quantities(const gap::Evidence& evidence, const Predictions& predictions,
                                 gap::Signal signal);

/// A mean error with its standard error; NaN where a bin has too little for either.
struct BinnedMean {
    std::vector<double> mean, std_error;
    double share = 0.0;  ///< of the squared error that the bins' means account for
};

struct BinnedErrors {
    std::vector<double> x;  ///< the bins' middles
    BinnedMean before, after;
};

/// Bins of equal width over the range of x, but for 0.2 % at each end. Errors of one window hang together:
/// the standard error comes from the scatter of the windows' means in a bin, weighted by their values.
BinnedErrors binned(const std::vector<Sample>& samples, std::size_t bins);

}  // namespace fidservo::diagnose
