// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The actuator's present state: room temperature, stroke and heater, from one sweep of the platform over its
// travel under known commands, measured by the calibrated Hall sensor.
#include "core/micro_model.h"
#include "core/result.h"

#include <span>

namespace fidservo::calib {

struct ActuatorTuning {
    HeaterParameters heater;
    double stroke_scale;
    double residual_mm;  ///< r.m.s. of the position, model minus sensor
};

/// Least squares over ambient temperature, stroke scale, heater gain and both time constants, each within
/// bounds around the rig file's value. The wire must start at room temperature, with the platform fully
/// extended.
/// @param position_mm  platform position at each tick
/// @param command_V    command held from each tick on
/// Fails with Reason::not_identifiable if the platform travelled less than half its stroke.
Result<ActuatorTuning> tune_actuator(const MicroModel& model, double tick_s,
                                     std::span<const double> position_mm, std::span<const double> command_V);

}  // namespace fidservo::calib
