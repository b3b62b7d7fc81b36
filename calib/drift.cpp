// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/drift.h"

#include "calib/significance.h"

#include <algorithm>
#include <cmath>

namespace fidservo::calib {

std::vector<DriftVerdict> judge_drift(std::span<const Expectation> list, double false_alarm) {
    std::vector<DriftVerdict> verdicts;
    if (list.empty()) return verdicts;
    const double z = normal_bound(0.5 * false_alarm / static_cast<double>(list.size()));
    for (const Expectation& of : list) {
        const double bound = std::max(of.matters, z * of.std);
        verdicts.push_back({of, bound, !(std::abs(of.measured - of.expected) <= bound)});
    }
    return verdicts;
}

}  // namespace fidservo::calib
