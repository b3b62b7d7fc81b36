// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Whether a camera's calibration is good enough, and if not, why.
#include "calib/camera/camera_calibration.h"
#include "core/plate.h"

#include <string>
#include <vector>

namespace fidservo::calib {

/// Where in the image corners were seen: a grid of cells over it, row by row.
struct Coverage {
    static constexpr int columns = 8, rows = 6;
    std::vector<int> corners;  ///< in each cell
    double share;              ///< of the cells that hold any
};

Coverage coverage_of(const CameraCalibration& calibration);

/// The largest angle between the target's normals in any two views, rad.
double widest_tilt_rad(const CameraCalibration& calibration);

/// How many views are not like another one: their directions differ by a degree, or their places by 2 % of
/// the distance.
int different_views(const CameraCalibration& calibration);

struct CalibrationLimits {
    double most_rms_px = 0.5;       ///< reprojection error
    double most_focal_std = 0.002;  ///< standard error of the focal length, as a share of it
    double least_coverage = 0.5;    ///< share of the image's cells
    int least_views = 5;            ///< that differ
};

/// What is wrong, one sentence for people each, the cause of a bad fit first; none: the calibration is good.
/// A cause is named only if it was tried (other_explanations.h) and explains the corners, an advice only if
/// it was worked out what it would bring (predicted_errors.h); of numbers that a lens yields which does not
/// explain the corners none is judged.
/// @param target  all of its tags
std::vector<std::string> shortcomings(const CameraCalibration& calibration, const CalibrationLimits& limits,
                                      const std::vector<PlateTag>& target);

/// What explains the corners of a good calibration better beyond chance, one sentence each: a lens of the
/// other model; tags of another size, where that moves a number of the lens by more than its standard error.
std::vector<std::string> notes_on(const CameraCalibration& calibration);

}  // namespace fidservo::calib
