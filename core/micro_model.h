// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The program's model of the micro stage: the rig file's numbers, corrected by its own measurements.
#include "core/hall.h"
#include "core/micro_parameters.h"
#include "core/preisach.h"

#include <array>
#include <memory>

namespace fidservo {

/// The program's model of a micro stage.
struct MicroModel {
    HeaterParameters heater;              ///< of the wire
    std::shared_ptr<const FodTable> fod;  ///< the wire's hysteresis
    double stroke_scale = 1.0;            ///< factor on the table's contraction f
    HallParameters hall;                  ///< the sensor's nominal curve
    /// Platform position in mm as a polynomial of d = nominal Hall position - centre:
    /// x = k0 + k1 d + k2 d^2 + k3 d^3.
    std::array<double, 4> hall_correction;
};

/// The model that the rig file states.
MicroModel nominal_micro_model(const MicroParameters& micro);

/// Platform position in mm (contraction; 0 = fully extended) of a Hall reading in counts.
double platform_position_mm(const MicroModel& model, double hall_adc);

/// Heater temperature rise in degC that a command in V would settle at: gain (c - onset), 0 below the onset.
double heater_rise_degC(const HeaterParameters& heater, double command_V);

/// The command in V that moves the wire at `rate_degC_per_s` when it is at `temp_degC`: the inverse of
/// dT/dt = (phi(c) - (T - Ta)) / tau. Not limited.
double heater_command_V(const HeaterParameters& heater, double temp_degC, double rate_degC_per_s);

/// Temperature in degC after holding a command for a time, exact: under a constant command the wire only
/// heats or only cools.
double heater_step_degC(const HeaterParameters& heater, double temp_degC, double command_V, double time_s);

/// Temperature in degC after a time of heating power that would settle at `rise_degC` above ambient.
double heated_degC(const HeaterParameters& heater, double temp_degC, double rise_degC, double time_s);

}  // namespace fidservo
