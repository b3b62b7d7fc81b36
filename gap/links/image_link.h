// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How a tag looks in its frame: blur, light and noise, from what the camera is claimed to be.
//
// Measured (core/appearance.h) and predicted are positive, and compared by the logarithm of their ratio:
//
//     edge     ln (blur^2 + extra blur^2 + 1/12 + (n . v)^2 T^2 / 12),   n the edge's normal
//     light    ln (L at the strip beside the edge), less the mean of these in the second
//     noise    ln (k g + (k r)^2 + (spread g)^2 + 1/12),   k = 255 / full well, for white and for black
//
// with T the exposure, r the read noise, g the measured grey level, L of plant/view/view_options.h. How
// bright the lamp and the paper are no rig file says, so light is compared within a second only. v is how the
// tag moves in the image, px/s, from where it is seen two frames before to two frames after, by the
// five-point formula; it depends on no model of the stages. Where those frames do not show the tag, edges are
// not judged; nor where their differences over one and over two frames are too far apart for the motion to be
// even, first differences (which jerk sets apart) or second ones (which a jump of the velocity does).
//
// floor^2 of a logarithm = (the measurement's own noise)^2 + allowance^2 + (what v is uncertain of)^2
//
// Allowances bound what measurements are off by beyond their noise: under the truth, evenly spread within
// them, a mean square is (floor^2 - 2/3 allowance^2) / floor^2.
#include "core/camera/camera_parameters.h"
#include "core/recording.h"
#include "gap/evidence.h"
#include "plant/camera.h"
#include "plant/stage_plant.h"

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace fidservo::gap {

/// An appearance's motion and floors.
struct ImageSighting {
    std::array<Eigen::Vector2d, 4> corners_px;  ///< of its detection
    Eigen::Vector2d velocity_px_per_s;
    std::array<double, image_values> floors;  ///< of the logarithms
    double expected_square;                   ///< mean under the truth, floors^2
    std::size_t second;                       ///< since the recording's first row
};

/// A frame: what one is off by says nothing of the next one.
struct ImageWindow {
    std::size_t first_row, end_row;  ///< of the recording: those until the next frame that is judged
    std::size_t first, end;          ///< sightings
    double expected_square;          ///< mean of theirs
};

struct ImageRun {
    std::vector<ImageSighting> sightings;  ///< of the recording's appearances
    std::vector<ImageWindow> windows;
};

/// Empty for a recording without appearances. Takes those out of it that are not judged.
ImageRun image_run(Recording& recording, const CameraParameters& camera);

struct ImageModel {
    CameraParameters camera;
    plant::CameraDeviation deviation;
};

/// In floors, prediction minus measurement: four edges, four strips of light, noise of white and of black.
/// NaN where a value was not measured.
using ImageErrors = std::array<double, image_values>;

/// Of all sightings.
std::vector<ImageErrors> image_errors(const ImageModel& model, const Recording& recording,
                                      const ImageRun& run);

}  // namespace fidservo::gap
