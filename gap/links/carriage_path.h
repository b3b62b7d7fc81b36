// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The carriage along a whole recording, composed of the simulations of its windows.
#include "gap/links/carriage_run.h"
#include "plant/encoder.h"

#include <vector>

namespace fidservo::gap {

/// The carriage's motion along a recording, without jumps. Within windows it is simulated; each simulation is
/// faded into that of the next window over the 100 ms before the next window, and shifted where it is off the
/// counts by more than half a count.
struct CarriagePath {
    std::vector<double> position_mm, velocity_mm_per_s;          ///< between windows: from the counts
    std::vector<double> acceleration_mm_per_s2, jerk_mm_per_s3;  ///< means from this row to the next
    /// In the 100 ms before a window, the position by that window's own simulation alone, without fading; NaN
    /// elsewhere.
    std::vector<double> entering_mm;
};

/// What is stored of a simulated carriage: only its positions, or also their derivatives.
enum class Followed { places, motion };

/// A path whose values are not known (NaN). If only positions are followed the other vectors are empty.
CarriagePath unknown_path(std::size_t rows, Followed followed);

/// The carriage's position in mm at a reading: the inverse of the encoder.
double position_mm(const plant::Encoder& encoder, double reading_count);

/// How far the carriage moves per count at a position.
double mm_per_count(const plant::Encoder& encoder, double position_mm);

/// Shifts the path in a window and in the 100 ms before it towards the counts. The shift is the amount by
/// which the mean error over pieces of 100 ms exceeds half a count, interpolated linearly between the pieces.
/// @param lead  path by the window's simulation in the 100 ms before the window, from index 0 on
void pull_to_counts(const plant::Encoder& encoder, const CarriageRun& run, const WindowRows& window,
                    CarriagePath& lead, CarriagePath& path);

/// Cross-fades, over the 100 ms before a window, from the path so far to the window's own simulation.
/// @param lead  path by the window's simulation in these rows, from index 0 on
void fade_in(const WindowRows& window, const CarriagePath& lead, CarriagePath& path);

/// Fills rows outside of windows from the counts, and rows without a count by linear interpolation.
void fill(const plant::Encoder& encoder, const CarriageRun& run, CarriagePath& path);

}  // namespace fidservo::gap
