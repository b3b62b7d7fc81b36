// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the wire of a rig file does at the temperatures of a recording, and what the platform makes of it.
#include "gap/evidence.h"

#include <cmath>
#include <vector>

namespace fidservo::gap {

/// Contraction by the rig file's table at the temperatures of Course, row by row, mm; what was before where a
/// temperature is missing. Demands a micro stage.
std::vector<float> wire_path_mm(const Evidence& evidence, std::size_t run);

/// The same path behind a play of some width: it follows where it is pushed, and stays after a turn until the
/// play is used up.
std::vector<float> behind_play(std::vector<float> path_mm, double width_mm);

/// The same values behind a lag of first order. Values that are not finite do not count.
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
