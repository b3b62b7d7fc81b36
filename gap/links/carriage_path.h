// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The carriage along a whole recording, composed of the simulations of its windows.
#include "gap/links/carriage_run.h"
#include "plant/encoder.h"

#include <vector>

namespace fidservo::gap {

/// The carriage's motion along a recording, without jumps: the simulations of the windows, each faded into
/// the next over the 100 ms before that, and shifted to the counts where they leave these by more than half a
/// count.
struct CarriagePath {
    std::vector<double> position_mm, velocity_mm_per_s;          ///< between windows: from the counts
    std::vector<double> acceleration_mm_per_s2, jerk_mm_per_s3;  ///< means from this row to the next
    /// In the rows before a window, the position by the simulation that leads into it, before it is faded in;
    /// NaN elsewhere.
    std::vector<double> entering_mm;
};

/// What is stored of a simulated carriage: positions alone, or also their derivatives.
enum class Followed { places, motion };

/// A path whose values are not known (NaN). If only positions are followed the other vectors are empty.
CarriagePath unknown_path(std::size_t rows, Followed followed);

/// The carriage's position in mm at a reading: the inverse of the encoder.
double position_mm(const plant::Encoder& encoder, double reading_count);

/// How far the carriage moves per count at a position.
double mm_per_count(const plant::Encoder& encoder, double position_mm);

/// Shifts the rows of a window, and those before it, to the counts: by how much the mean error over pieces of
/// 100 ms exceeds half a count, interpolated linearly from piece to piece.
/// @param lead  path in the rows before the window, which begin at its index 0
void pull_to_counts(const plant::Encoder& encoder, const CarriageRun& run, const WindowRows& window,
                    CarriagePath& lead, CarriagePath& path);

/// Fades, over the rows before a window, from the path there to the simulation that leads into the window.
/// @param lead  path of that simulation, which begins at its index 0
void fade_in(const WindowRows& window, const CarriagePath& lead, CarriagePath& path);

/// Fills rows outside of windows from the counts, and rows without a count by linear interpolation.
void fill(const plant::Encoder& encoder, const CarriageRun& run, CarriagePath& path);

}  // namespace fidservo::gap
