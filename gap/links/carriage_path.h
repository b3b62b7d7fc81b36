// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The carriage along a whole recording, put together from the runs of its windows.
#include "gap/links/carriage_run.h"
#include "plant/encoder.h"

#include <vector>

namespace fidservo::gap {

/// The carriage along a recording without jumps: the windows' runs, each faded into the next over the 100 ms
/// before it, pulled back to the counts where they leave them by more than half a count.
struct CarriagePath {
    std::vector<double> position_mm, velocity_mm_per_s;          ///< between windows: by the counts
    std::vector<double> acceleration_mm_per_s2, jerk_mm_per_s3;  ///< from this row to the next, mean
    /// In the rows before a window, by the run that enters it, before it is faded in; NaN elsewhere.
    std::vector<double> entering_mm;
};

/// What is followed of a carriage.
enum class Followed { places, motion };

/// A path of which nothing is known: NaN; of places alone, nothing else has a value.
CarriagePath unknown_path(std::size_t rows, Followed followed);

/// The carriage's place of a reading, in mm: the inverse of the encoder.
double position_mm(const plant::Encoder& encoder, double reading_count);

/// How far the carriage moves per count.
double mm_per_count(const plant::Encoder& encoder, double position_mm);

/// Pulls the rows of a window and those before it back to the counts, by straight lines between the means of
/// pieces of 100 ms.
/// @param lead  the rows before the window, from 0
void pull_to_counts(const plant::Encoder& encoder, const CarriageRun& run, const WindowRows& window,
                    CarriagePath& lead, CarriagePath& path);

/// Fades from what the rows before a window show to what its own run shows there.
void fade_in(const WindowRows& window, const CarriagePath& lead, CarriagePath& path);

/// Fills rows outside of windows by the counts, and rows without a count by straight lines.
void fill(const plant::Encoder& encoder, const CarriageRun& run, CarriagePath& path);

}  // namespace fidservo::gap
