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
    double share;              ///< fraction of the cells that hold any corner
};

Coverage coverage_of(const CameraCalibration& calibration);

/// The largest angle between the target's normals in any two views, rad.
double widest_tilt_rad(const CameraCalibration& calibration);

/// How many views differ from all others: in direction by a degree, or in position by 2 % of the distance.
int different_views(const CameraCalibration& calibration);

struct CalibrationLimits {
    double most_rms_px = 0.5;       ///< reprojection error
    double most_focal_std = 0.002;  ///< relative standard error of the focal length
    double least_coverage = 0.5;    ///< fraction of the image's cells that hold corners
    int least_views = 5;            ///< number of views that differ from each other
};

/// The faults of a calibration, one sentence each, the cause of a bad fit first; empty if the calibration is
/// good. A cause is named only if a calibration with it (other_explanations.h) explains the corners; advice
/// is given only if its benefit was computed (predicted_errors.h). If the lens does not explain the corners,
/// its parameters are not judged.
/// @param target  all tags of the target
std::vector<std::string> shortcomings(const CameraCalibration& calibration, const CalibrationLimits& limits,
                                      const std::vector<PlateTag>& target);

/// Alternatives that explain the corners of a good calibration significantly better, one sentence each: a
/// lens of the other model; tags of another size, where that changes a number of the lens by more than its
/// standard error.
std::vector<std::string> notes_on(const CameraCalibration& calibration);

}  // namespace fidservo::calib
