// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/simulation/experiment_law.h"

#include "core/rig.h"
#include "src/files/recording/layout.h"

#include <algorithm>
#include <cmath>

namespace fidservo {

namespace {

/// What follows a course of voltages; the motor or the heater is off where it is not in force.
double voltage_V(const Course& course, double t_s, double low_V, double high_V) {
    const double command_V = value_at(course, t_s);
    return std::isnan(command_V) ? 0.0 : std::clamp(command_V, low_V, high_V);
}

void command_macro(const Rig& rig, const Experiment& experiment, double zero_count, double t_s,
                   ExperimentLoops& loops, StageRow& row) {
    const double limit_V = rig.macro.command_limit_V;
    row.macro_setpoint_mm = value_at(experiment.macro_setpoint_mm, t_s);
    if (std::isnan(row.macro_setpoint_mm)) {
        loops.pd = {};
        loops.pid = {};
        row.macro_command_V = voltage_V(experiment.macro_V, t_s, -limit_V, limit_V);
        return;
    }
    const double setpoint_count =
        std::floor(row.macro_setpoint_mm / rig.macro.encoder_resolution_mm + 0.5) + zero_count;
    const double error_count = setpoint_count - row.encoder_count;
    row.macro_command_V =
        experiment.macro_loop == MacroLoop::nonlinear_pd
            ? control::pd_update(*rig.macro.pd, limit_V, loops.pd, error_count)
            : control::pid_update(*rig.macro.pid, limit_V, rig.tick_s, loops.pid, error_count);
}

void command_micro(const Rig& rig, const Experiment& experiment, double t_s, ExperimentLoops& loops,
                   StageRow& row) {
    row.micro_setpoint_mm = value_at(experiment.micro_setpoint_mm, t_s);
    if (std::isnan(row.micro_setpoint_mm)) {
        loops.pi.reset();
        const double limit_V = rig.micro ? rig.micro->heater.limit_V : 0.0;
        row.micro_command_V = voltage_V(experiment.micro_V, t_s, 0.0, limit_V);
        return;
    }
    const double position_mm = hall_position_mm_of_adc(rig.micro->hall, row.hall_adc);
    if (!loops.pi) loops.pi = control::pi_start(*rig.micro->pi);
    row.micro_command_V =
        control::pi_update(*rig.micro->pi, rig.tick_s, *loops.pi, row.micro_setpoint_mm - position_mm);
}

}  // namespace

void command_tick(const Rig& rig, const Experiment& experiment, double zero_count, double t_s,
                  ExperimentLoops& loops, StageRow& row) {
    command_macro(rig, experiment, zero_count, t_s, loops, row);
    command_micro(rig, experiment, t_s, loops, row);
}

std::optional<ControllerNames> controllers_of(const Experiment& experiment) {
    ControllerNames names;
    if (experiment.macro_setpoint_mm)
        names.macro = experiment.macro_loop == MacroLoop::nonlinear_pd ? controller_name::nonlinear_pd
                                                                       : controller_name::benchmark_pid;
    if (experiment.micro_setpoint_mm) names.micro = controller_name::pi_antiwindup;
    if (names.macro.empty() && names.micro.empty()) return std::nullopt;
    return names;
}

}  // namespace fidservo
