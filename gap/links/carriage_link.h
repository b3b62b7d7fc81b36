// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// From the macro command to the encoder: a hypothesis's carriage along a recording.
//
// In each window the plant runs freely under the recorded commands. It enters the 100 ms before the window
// with what the window before has carried there (commands on their way, play, bristles, belt; through an end
// of travel too), or where that one is not run with what the counts tell of it (gap/links/counted_way.h), at
// the place and the velocity that fit these 100 ms best: each count says that the carriage was within half a
// count of it, and the carried state is a weak prior. So a carriage at rest within its count stays where it
// was carried to, and gets no velocity out of rounding. Least squares of what lies beyond half a count of
//
//     e_k + dy + tau (1 - exp(-t_k / tau)) dv          e: prediction minus count; dy, dv: corrections
//
// by Newton's method; where the plant has no closed form or the encoder a ripple, again from what the
// corrected plant shows.
#include "gap/links/carriage_path.h"
#include "gap/links/carriage_run.h"
#include "plant/stage_plant.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace fidservo::gap {

/// Axis and encoder of a hypothesis.
struct CarriageModel {
    plant::MacroAxis axis;
    plant::MacroAxis endless_axis;  ///< without ends of travel, for readings from an unknown origin
    plant::Encoder encoder;
    double start_offset_count = 0.0;  ///< by which windows begin beside the place that fits best
};

/// Throws InputError as make_macro_axis does.
CarriageModel carriage_model(const plant::PlantParameters& parameters);

/// Readings before rounding, and what it took to predict them.
struct PredictedCounts {
    std::vector<double> counts;  ///< for the rows of the windows wanted; NaN elsewhere, or there too
    std::size_t effort = 0;      ///< in rows of a carriage that is followed in closed form
};

/// @param wanted  a flag for each of the run's windows, stretch after stretch
PredictedCounts predicted_counts(const CarriageModel& model, const CarriageRun& run,
                                 std::span<const std::uint8_t> wanted);

/// For all windows, and the path.
PredictedCounts predicted_counts(const CarriageModel& model, const CarriageRun& run, CarriagePath& path);

}  // namespace fidservo::gap
