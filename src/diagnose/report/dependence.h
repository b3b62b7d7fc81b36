// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The dependence of errors on quantities such as velocity, position and temperature: mean errors in bins.
#include "src/diagnose/report/predictions.h"

#include <cstdint>
#include <string>
#include <vector>

namespace fidservo::diagnose {

/// A quantity's value x with the error there without and with the explanation.
struct Sample {
    float x, before, after;  ///< x, and both errors in floors
    std::uint32_t window;
};

/// A quantity on which a signal's error may depend.
struct Quantity {
    std::string name;        ///< as in gap::Remainder, so that one can be found by the other
    std::string axis_label;  ///< with its unit
    std::vector<Sample> samples;
};

/// The quantities that vary in the recordings.
std::vector<Quantity> quantities(const gap::Evidence& evidence, const Predictions& predictions,
                                 gap::Signal signal);

/// A mean error with its standard error; NaN where a bin has too few values.
struct BinnedMean {
    std::vector<double> mean, std_error;
    double share = 0.0;  ///< fraction of the squared error that the bins' means explain
};

struct BinnedErrors {
    std::vector<double> x;  ///< the bins' middles
    BinnedMean before, after;
};

/// Bins of equal width over the range of x, but for 0.2 % at each end. Errors within a window are correlated:
/// the standard error comes from the scatter of the windows' means in a bin, weighted by their values.
BinnedErrors binned(const std::vector<Sample>& samples, std::size_t bins);

}  // namespace fidservo::diagnose
