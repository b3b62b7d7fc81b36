// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The carriage's data of a recording, and the windows in which they can be compared with a model.
#include "core/macro_parameters.h"
#include "core/recording.h"
#include "gap/budget.h"
#include "gap/evidence/windows.h"
#include "gap/links/counted_way.h"

#include <cstddef>
#include <memory>
#include <vector>

namespace fidservo::gap {

/// The carriage's data. Vectors have one value for each row of the recording unless stated otherwise.
struct CarriageRun {
    double tick_s = 0.0;
    std::shared_ptr<const Budget> budget;  ///< checked by simulations of the recording; may be null
    std::vector<double> time_s;            ///< since the first row
    std::vector<double> command_V;         ///< NaN where missing
    std::vector<double> reading_count;  ///< NaN where missing; position / resolution where that was recorded
    CountedWay way;
    std::vector<std::vector<WindowRows>> windows;  ///< for each stretch; only where the carriage is free
    std::vector<std::size_t> run_on_end;  ///< for each stretch, end of the rows after it with known commands
    /// Whether the carriage stands: in the 50 ms before and after a row, the reading is constant or
    /// alternates between two counts, since feedback from counts holds the carriage at the border between
    /// two.
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

/// Prediction minus reading in counts. While the reading is constant, all positions that round to it are
/// equally good; the error is then the part beyond half a count.
double counted_error(const CarriageRun& run, std::size_t row, double predicted_count);

/// The part of an error beyond half a count, with the error's sign; 0 for smaller errors.
double beyond_rounding(double error_count);

}  // namespace fidservo::gap
