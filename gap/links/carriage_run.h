// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a recording says of the carriage, and where it may be compared with a model of it.
#include "core/macro_parameters.h"
#include "core/recording.h"
#include "gap/budget.h"
#include "gap/evidence/windows.h"
#include "gap/links/counted_way.h"

#include <cstddef>
#include <memory>
#include <vector>

namespace fidservo::gap {

/// Row by row.
struct CarriageRun {
    double tick_s = 0.0;
    std::shared_ptr<const Budget> budget;  ///< asked by what runs along the recording; may be empty
    std::vector<double> time_s;            ///< since the first row
    std::vector<double> command_V;         ///< NaN where missing
    std::vector<double> reading_count;     ///< likewise; position / resolution where that was recorded
    CountedWay way;
    std::vector<std::vector<WindowRows>> windows;  ///< by stretch; only where the carriage is free
    std::vector<std::size_t> run_on_end;  ///< of each stretch: up to which row commands go on after it
    /// Whether, for 50 ms before and after, the reading is the same or goes to and fro between two counts: a
    /// controller that sees counts keeps the carriage at the edge of one.
    std::vector<bool> stands;
    bool is_homed = false;  ///< readings are places in the rig file's travel
};

/// A row's count; where the position was recorded, position / resolution.
double reading_count(const StageRow& row, const MacroParameters& macro);

/// Of the carriage by the rig file.
double time_constant_s(const MacroParameters& macro, double tick_s);

/// Recorded places row by row, mm; NaN where missing.
std::vector<double> readings_mm(const Recording& recording, const MacroParameters& macro);

/// @param is_homed  whether readings are places in the rig file's travel
CarriageRun carriage_run(const Recording& recording, const MacroParameters& macro, bool is_homed = true);

/// Prediction minus reading in counts. Where the reading stands, a place that rounds to it is as good as any
/// other: the error is what lies beyond half a count.
double counted_error(const CarriageRun& run, std::size_t row, double predicted_count);

/// What lies beyond half a count of an error.
double beyond_rounding(double error_count);

}  // namespace fidservo::gap
