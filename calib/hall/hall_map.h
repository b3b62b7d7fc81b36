// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Calibrates the Hall sensor by the camera: both measure the displacement of the platform while it moves over
// its travel.
//
// With d(t) the position by the rig file's Hall curve, relative to its centre, and s_i the camera's position
// stamped t_i,
//     s_i = y + k1 d(t_i - delay) + k2 d^2 + k3 d^3,
// a fit yields the sensor's true scale and curvature, and the delay of the camera's time stamps.
#include "core/micro_model.h"
#include "core/result.h"
#include "core/time.h"

#include <span>
#include <vector>

namespace fidservo::calib {

/// The Hall sensor's readings, one per tick, from `start_ns` on.
struct HallTrace {
    TimeNs start_ns;
    TimeNs tick_ns;
    std::vector<double> adc;
};

struct CameraSight {
    TimeNs time_ns;  ///< as stamped
    double s_mm;     ///< plate x under the optical axis
    double s_std_mm;
};

struct HallMap {
    /// MicroModel::hall_correction; position zero at the trace's first readings (platform extended).
    std::array<double, 4> correction;
    double camera_delay_s;  ///< delay of the camera's time stamps behind the exposures
    double camera_delay_std_s;
    double scale_std;    ///< standard error of the slope at the centre
    double residual_mm;  ///< r.m.s. of camera position minus fit
};

/// @param exposure_s  the time over which the Hall reading is averaged
/// @param rest_ticks  number of ticks at the trace's start for which the platform was at rest, fully extended
/// Fails with Reason::not_identifiable if the platform moved less than 1 mm in view or fewer than 12 frames
/// saw it.
Result<HallMap> fit_hall_map(const HallParameters& hall, const HallTrace& trace,
                             std::span<const CameraSight> sights, double exposure_s, int rest_ticks);

}  // namespace fidservo::calib
