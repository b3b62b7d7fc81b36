// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The chapters of the report, each from its own experiments. They throw InputError where the rig lacks what
// they need.
#include "src/reproduce/chapter.h"
#include "src/reproduce/laboratory.h"

namespace fidservo::reproduce {

Chapter open_loop_macro(const Laboratory& laboratory);  ///< eq. 5 to 7, fig. 9
Chapter wire_hysteresis(const Laboratory& laboratory);  ///< eq. 8, fig. 12
Chapter heater(const Laboratory& laboratory);           ///< fig. 13 to 16
Chapter hall_sensor(const Laboratory& laboratory);      ///< its calibration curve
Chapter benchmark_pid(const Laboratory& laboratory);    ///< fig. 17
Chapter nonlinear_pd(const Laboratory& laboratory);     ///< fig. 18, 19, eq. 9
Chapter micro_steps(const Laboratory& laboratory);      ///< fig. 21, accuracy and settling
Chapter micro_bandwidth(const Laboratory& laboratory);  ///< over the full travel
Chapter integrated_task(const Laboratory& laboratory);  ///< fig. 22
/// Effects that the paper leaves for later: other friction, coupling, a second thermal mass.
Chapter beyond_model(const Laboratory& laboratory);

}  // namespace fidservo::reproduce
