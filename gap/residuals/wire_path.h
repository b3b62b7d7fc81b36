// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The wire's contraction by the rig file at the temperatures of a recording, and how it reaches the platform.
#include "gap/evidence.h"

#include <cmath>
#include <vector>

namespace fidservo::gap {

/// Contraction by the rig file's table at the temperatures of Course, row by row, mm; where a temperature is
/// missing, the value before. Demands a micro stage.
std::vector<float> wire_path_mm(const Evidence& evidence, std::size_t run);

/// The output of a play (backlash) operator: after a reversal it rests until the input has moved by
/// `width_mm`.
std::vector<float> behind_play(std::vector<float> path_mm, double width_mm);

/// The output of a first-order lag for these values as input. At values that are not finite it stays
/// constant.
template <class Value>
std::vector<Value> behind_lag(std::vector<Value> values, double tau_s, double tick_s) {
    const double share = -std::expm1(-tick_s / tau_s);
    double memory = values.empty() ? 0.0 : static_cast<double>(values.front());
    for (Value& value : values) {
        if (std::isfinite(value)) memory += share * (static_cast<double>(value) - memory);
        value = static_cast<Value>(memory);
    }
    return values;
}

}  // namespace fidservo::gap
