// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A calibration's numbers as a list: for tables, JSON and the rig file's provenance.
#include "src/calibrate/stage_numbers.h"

#include <string>
#include <vector>

namespace fidservo {

struct StageValue {
    std::string key;  ///< in the rig file, an element of a list as NAME[i]; else a name of its own
    std::string unit;
    double value, std;
    bool in_rig_file;
    double file;  ///< what the rig file says, where it is in there
};

std::vector<StageValue> stage_values(const Rig& rig, const StageNumbers& numbers);

/// "1.23456 +- 0.00012": as many digits as the standard error has meaning.
std::string with_std(const StageValue& value);

/// Sentences for people: what does not fit, what else was measured.
std::vector<std::string> stage_notes(const StageNumbers& numbers);

}  // namespace fidservo
