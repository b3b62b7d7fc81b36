#include "src/simulation/run_experiment.h"

#include "control/nonlinear_pd.h"
#include "control/pi_antiwindup.h"
#include "core/random.h"
#include "core/rig.h"
#include "src/recording/writer.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace fidservo {

namespace {

/// The published controllers, as far as the experiment closes their loops.
struct Loops {
    control::PdState pd;
    control::PidState pid;
    std::optional<control::PiState> pi;
};

double macro_command_V(const Rig& rig, const Experiment& experiment, Loops& loops, StageRow& row,
                       double t_s) {
    const double limit_V = rig.macro.command_limit_V;
    row.macro_setpoint_mm = value_at(experiment.macro_setpoint_mm, t_s);
    if (std::isnan(row.macro_setpoint_mm)) {
        loops.pd = {};
        loops.pid = {};
        const double command_V = value_at(experiment.macro_V, t_s);
        return std::isnan(command_V) ? 0.0 : std::clamp(command_V, -limit_V, limit_V);
    }
    const double setpoint_count = std::floor(row.macro_setpoint_mm / rig.macro.encoder_resolution_mm + 0.5);
    const double error_count = setpoint_count - row.encoder_count;
    return experiment.macro_loop == MacroLoop::nonlinear_pd
               ? control::pd_update(*rig.macro.pd, limit_V, loops.pd, error_count)
               : control::pid_update(*rig.macro.pid, limit_V, rig.tick_s, loops.pid, error_count);
}

double micro_command_V(const Rig& rig, const Experiment& experiment, Loops& loops, StageRow& row,
                       double t_s) {
    row.micro_setpoint_mm = value_at(experiment.micro_setpoint_mm, t_s);
    if (std::isnan(row.micro_setpoint_mm)) {
        loops.pi.reset();
        const double command_V = value_at(experiment.micro_V, t_s);
        return std::isnan(command_V) ? 0.0 : std::clamp(command_V, 0.0, rig.micro->heater.limit_V);
    }
    const double position_mm = hall_position_mm_of_adc(rig.micro->hall, row.hall_adc);
    if (!loops.pi) loops.pi = control::pi_start(*rig.micro->pi);
    return control::pi_update(*rig.micro->pi, rig.tick_s, *loops.pi, row.micro_setpoint_mm - position_mm);
}

}  // namespace

std::uint64_t noise_seed(const std::string& name, std::uint64_t seed) {
    return NoiseStream(seed, "noise/" + name).bits();
}

Recording run_experiment(const Rig& rig, const Experiment& experiment, const std::string& name,
                         SimulatedHardware& hardware) {
    Recording recording;
    recording.name = name;
    recording.rig = rig.name;
    recording.experiment = experiment.kind;
    recording.tick_s = rig.tick_s;
    recording.columns = columns_of(rig);
    const TimeNs tick_ns = nanoseconds(rig.tick_s);
    const auto ticks = static_cast<TimeNs>(std::llround(experiment.duration_s / rig.tick_s));
    recording.rows.reserve(static_cast<std::size_t>(ticks));
    Loops loops;
    for (TimeNs k = 0; k < ticks; ++k) {
        const SimulatedHardware::Reading reading = hardware.sample();
        StageRow row{.time_ns = k * tick_ns};
        row.encoder_count = static_cast<double>(reading.encoder_count);
        row.hall_adc = reading.hall_adc;
        const double t_s = static_cast<double>(k) * rig.tick_s;
        row.macro_command_V = macro_command_V(rig, experiment, loops, row, t_s);
        row.micro_command_V = micro_command_V(rig, experiment, loops, row, t_s);
        recording.rows.push_back(row);
        hardware.look(row.time_ns, row.macro_command_V, row.micro_command_V, recording.detections);
        hardware.advance(row.macro_command_V, row.micro_command_V);
    }
    return recording;
}

}  // namespace fidservo
