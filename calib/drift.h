// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Whether measured numbers differ from their expected values, by more than chance and by enough to matter.
#include <span>
#include <string>
#include <vector>

namespace fidservo::calib {

struct Expectation {
    std::string quantity;
    std::string unit;
    double expected;
    double measured;
    double std;      ///< standard deviation of measured - expected
    double matters;  ///< smaller differences do not count as drift
};

struct DriftVerdict {
    Expectation of;
    double bound;  ///< |measured - expected| above this is a drift
    bool drifted;
};

/// A quantity has drifted if |measured - expected| exceeds both `matters` and z std, z such that under normal
/// errors the probability of any false alarm in the list is at most `false_alarm` (Bonferroni).
/// A difference that is not a number counts as drifted.
std::vector<DriftVerdict> judge_drift(std::span<const Expectation> list, double false_alarm = 0.01);

}  // namespace fidservo::calib
