// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/simulation/run_experiment.h"

#include "core/random.h"
#include "core/rig.h"
#include "src/files/recording/writer.h"
#include "src/simulation/experiment_law.h"

#include <cmath>

namespace fidservo {

std::uint64_t noise_seed(const std::string& name, std::uint64_t seed) {
    return NoiseStream(seed, "noise/" + name).bits();
}

EncoderZero simulated_zero() {
    return {0.0, 0.0, "simulated"};
}

Recording run_experiment(const Rig& rig, const Experiment& experiment, const std::string& name,
                         SimulatedHardware& hardware) {
    Recording recording;
    recording.name = name;
    recording.rig = rig.name;
    recording.experiment = experiment.kind;
    recording.tick_s = rig.tick_s;
    recording.encoder_zero = simulated_zero();
    recording.controllers = controllers_of(experiment);
    recording.columns = columns_of(rig);
    const TimeNs tick_ns = nanoseconds(rig.tick_s);
    const auto ticks = static_cast<TimeNs>(std::llround(experiment.duration_s / rig.tick_s));
    recording.rows.reserve(static_cast<std::size_t>(ticks));
    ExperimentLoops loops;
    for (TimeNs k = 0; k < ticks; ++k) {
        const SimulatedHardware::Reading reading = hardware.sample();
        StageRow row{.time_ns = k * tick_ns};
        row.encoder_count = static_cast<double>(reading.encoder_count);
        row.hall_adc = reading.hall_adc;
        const double t_s = static_cast<double>(k) * rig.tick_s;
        command_tick(rig, experiment, 0.0, t_s, loops, row);
        recording.rows.push_back(row);
        hardware.look(row.time_ns, row.macro_command_V, row.micro_command_V, recording.detections);
        hardware.advance(row.macro_command_V, row.micro_command_V);
    }
    return recording;
}

}  // namespace fidservo
