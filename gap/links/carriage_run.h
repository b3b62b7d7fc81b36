// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The carriage's part of a recording, and the windows in which it can be compared with a model.
#include "core/macro_parameters.h"
#include "core/recording.h"
#include "gap/budget.h"
#include "gap/evidence/windows.h"
#include "gap/links/counted_way.h"

#include <cstddef>
#include <memory>
#include <vector>

namespace fidservo::gap {

/// One value for each row, where nothing else is said.
struct CarriageRun {
    double tick_s = 0.0;
    std::shared_ptr<const Budget> budget;  ///< checked by what simulates along the recording; may be null
    std::vector<double> time_s;            ///< since the first row
    std::vector<double> command_V;         ///< NaN where missing
    std::vector<double> reading_count;  ///< NaN where missing; position / resolution where that was recorded
    CountedWay way;
    std::vector<std::vector<WindowRows>> windows;  ///< for each stretch; only where the carriage is free
    std::vector<std::size_t> run_on_end;  ///< for each stretch, the row up to which commands go on after it
    /// Whether, in the 50 ms before and after a row, the reading is constant or alternates between two
    /// counts: a controller that sees counts keeps the carriage at the edge of one.
    std::vector<bool> stands;
    bool is_homed = false;  ///< whether readings are positions in the rig file's travel
};

/// A row's reading in counts; where the position was recorded instead, position / resolution.
double reading_count(const StageRow& row, const MacroParameters& macro);

/// Time constant of the velocity by the rig file.
double time_constant_s(const MacroParameters& macro, double tick_s);

/// Recorded positions row by row, mm; NaN where missing.
std::vector<double> readings_mm(const Recording& recording, const MacroParameters& macro);

/// @param is_homed  whether readings are positions in the rig file's travel
CarriageRun carriage_run(const Recording& recording, const MacroParameters& macro, bool is_homed = true);

/// Prediction minus reading in counts. While the reading is constant every position that rounds to it is as
/// good as any other: the error is then what exceeds half a count.
double counted_error(const CarriageRun& run, std::size_t row, double predicted_count);

/// What exceeds half a count in an error, with the error's sign.
double beyond_rounding(double error_count);

}  // namespace fidservo::gap
