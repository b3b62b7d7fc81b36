// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The camera-to-stage calibration as a command runs it: it moves a homed rig, computes the numbers and writes
// the files.
#include "core/plate.h"
#include "src/calibrate/stage_numbers.h"
#include "src/calibrate/stage_verdict.h"

#include <filesystem>
#include <vector>

namespace fidservo {

/// A calibration with the data on which it is based.
struct StageCalibration {
    std::vector<StageShot> shots;
    StageNumbers numbers;  ///< points into the shots
    std::vector<FreshTest> tests;
    double rig_time_s;

    bool passed() const;
};

/// The result as a table for the terminal.
std::string describe(const Rig& rig, const StageCalibration& calibration);
std::string describe(const std::vector<calib::DriftVerdict>& verdicts);

/// DIR/stage.json: {"format": "fidservo-stage-calibration/1", "values": [{"key", "unit", "value", "std"}],
/// "tests": [...], "passed"}; DIR/stands.csv, a row for each tag at each stand; DIR/report.html.
void write_stage_calibration(const std::filesystem::path& folder, const Rig& rig,
                             const StageCalibration& calibration);
/// DIR/check.json: {"format": "fidservo-stage-check/1", "healthy", "quantities": [{"quantity", "unit",
/// "expected", "measured", "std", "bound", "verdict"}]}.
void write_stage_check(const std::filesystem::path& folder, const std::vector<calib::DriftVerdict>& verdicts);
/// The report's HTML.
std::string stage_report(const Rig& rig, const StageCalibration& calibration);

/// A copy of a rig file with the calibrated numbers in it.
void write_stage_rig(const std::filesystem::path& file, const std::filesystem::path& source_rig_file,
                     const Rig& rig, const StageCalibration& calibration);

}  // namespace fidservo
