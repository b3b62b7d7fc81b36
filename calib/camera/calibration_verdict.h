#pragma once
// Whether a camera's calibration is good enough, and if not, why.
#include "calib/camera/camera_calibration.h"

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

/// What is wrong, one sentence for people each. None: the calibration is good.
std::vector<std::string> shortcomings(const CameraCalibration& calibration, const CalibrationLimits& limits);

}  // namespace fidservo::calib
