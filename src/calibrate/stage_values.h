// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A calibration's results as a list, for tables, JSON and the rig file's provenance.
#include "src/calibrate/stage_numbers.h"

#include <string>
#include <vector>

namespace fidservo {

struct StageValue {
    std::string key;  ///< key in the rig file, NAME[i] for an element of a list; else a name of its own
    std::string unit;
    double value, std;
    bool in_rig_file;
    double file;  ///< the rig file's value, where it has one
};

std::vector<StageValue> stage_values(const Rig& rig, const StageNumbers& numbers);

/// A value with its standard error, rounded to significant digits: "1.23456 +- 0.00012".
std::string with_std(const StageValue& value);

/// Notes for the user: what does not fit, and what else was measured.
std::vector<std::string> stage_notes(const StageNumbers& numbers);

}  // namespace fidservo
