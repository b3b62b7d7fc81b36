// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A tag's appearance in its frame: blur, light and noise, predicted from a hypothesis's camera.
//
// Measured (core/appearance.h) and predicted values are positive, and compared by the logarithm of their
// ratio:
//
//     edge     ln (blur^2 + extra blur^2 + 1/12 + (n . v)^2 T^2 / 12),   n the edge's normal
//     light    ln (L at the strip beside the edge), minus the mean of this error over each second
//     noise    ln (k g + (k r)^2 + (spread g)^2 + 1/12),   k = 255 / full well, for white and for black
//
// with T the exposure, r the read noise, g the measured grey level, and L the light of
// plant/view/view_options.h. No rig file states how bright lamp and paper are, so that light is compared
// within a second only. v is the tag's velocity in the image, px/s, by the five-point formula from its
// positions two frames before to two frames after; it depends on no model of the stages. A tag is not judged
// in a frame if one of the five frames does not show it, or if the motion is not smooth enough for the
// formula: the first differences (jerk) or the second differences (a jump of the velocity) over one frame and
// over two frames disagree too much.
//
// floor^2 of a logarithm = (the measurement's own noise)^2 + allowance^2 + (effect of v's uncertainty)^2
//
// An allowance is a bound of the systematic error of a measurement. If systematic errors are uniformly
// distributed within the bound, the mean square error of the true model, in floors^2, is (floor^2 - 2/3
// allowance^2) / floor^2.
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

/// The motion and the floors of an appearance.
struct ImageSighting {
    std::array<Eigen::Vector2d, corner_count> corners_px;  ///< corners of the tag's detection
    Eigen::Vector2d velocity_px_per_s;
    std::array<double, image_values> floors;  ///< floors of the logarithms of the ratios
    double expected_square;                   ///< mean square of its errors under the truth, floors^2
    std::size_t second;                       ///< number of whole seconds since the recording's first row
};

/// A frame as a window of its own, since the errors of successive frames are independent.
struct ImageWindow {
    std::size_t first_row, end_row;  ///< rows of the recording, up to the next frame that is judged
    std::size_t first, end;          ///< range of its sightings
    double expected_square;          ///< mean over its sightings
};

struct ImageRun {
    std::vector<ImageSighting> sightings;  ///< one for each of the recording's appearances
    std::vector<ImageWindow> windows;
};

/// Removes from the recording the appearances that are not judged. Empty for a recording without appearances.
ImageRun image_run(Recording& recording, const CameraParameters& camera);

struct ImageModel {
    CameraParameters camera;
    plant::CameraDeviation deviation;
};

/// Prediction minus measurement, in floors: four edges, four strips of light, noise of white and of black.
/// NaN where a value was not measured.
using ImageErrors = std::array<double, image_values>;

/// The errors of all sightings.
std::vector<ImageErrors> image_errors(const ImageModel& model, const Recording& recording,
                                      const ImageRun& run);

}  // namespace fidservo::gap
