// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// From the macro command to the encoder: the carriage along a recording, under a hypothesis.
//
// In each window the plant runs freely under the recorded commands. The simulation begins 100 ms before the
// window, in the state (delayed commands, play, bristles, belt) in which the simulation of the preceding
// window has arrived there, also through an end of travel. If the preceding window is not simulated, the
// state of play and bristles follows from the counts (gap/links/counted_way.h). Its position and velocity are
// corrected such that they fit the counts of these 100 ms best. A count says only that the carriage was
// within half a count of it, and the uncorrected state is a weak prior. A carriage at rest within its count
// therefore keeps its simulated position, and rounding gives it no velocity. The corrections dy and dv
// minimise the squares of what exceeds half a count in
//
//     e_k + dy + tau (1 - exp(-t_k / tau)) dv          e_k: prediction minus count at t_k, tau: time constant
//
// by Newton's method; where the plant has no closed-form solution or the encoder a ripple, this is repeated
// with the corrected plant's errors.
#include "gap/links/carriage_path.h"
#include "gap/links/carriage_run.h"
#include "plant/stage_plant.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace fidservo::gap {

/// The axis and the encoder of a hypothesis.
struct CarriageModel {
    plant::MacroAxis axis;
    plant::MacroAxis endless_axis;  ///< without ends of travel, for readings from an unknown origin
    plant::Encoder encoder;
    double start_offset_count = 0.0;  ///< added to the position at the start of each window
};

/// Throws InputError as make_macro_axis does.
CarriageModel carriage_model(const plant::PlantParameters& parameters);

/// Readings before rounding, and the cost of predicting them.
struct PredictedCounts {
    std::vector<double> counts;  ///< in all rows of the wanted windows; other rows may be NaN
    std::size_t effort = 0;      ///< cost, in rows of a carriage that is simulated in closed form
};

/// @param wanted  a flag for each of the run's windows, in the order of CarriageRun::windows
PredictedCounts predicted_counts(const CarriageModel& model, const CarriageRun& run,
                                 std::span<const std::uint8_t> wanted);

/// The same for all windows; also stores the carriage's path.
PredictedCounts predicted_counts(const CarriageModel& model, const CarriageRun& run, CarriagePath& path);

}  // namespace fidservo::gap
