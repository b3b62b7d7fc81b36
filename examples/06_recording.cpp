// SPDX-License-Identifier: GPL-3.0-or-later
// A recording, written and read again: a second of the simulated rig, in the layout that all commands read.
//
//     06_recording RIG.yaml FOLDER        FOLDER must not exist
#include "core/recording.h"
#include "core/rig.h"
#include "plant/stage_plant.h"
#include "src/files/recording/reader.h"
#include "src/files/recording/writer.h"
#include "src/files/rig/rig_file.h"

#include <cmath>
#include <cstdio>

namespace {

using namespace fidservo;

/// A sine of 2 Hz at the motor, from the middle of the travel, and what the encoder reads of it.
Recording record(const Rig& rig) {
    const plant::StagePlant plant = plant::make_stage_plant(rig);
    plant::StageState state = plant::start(plant, 100.0, 1);
    Recording recording;
    recording.name = recording.experiment = "sine";
    recording.rig = rig.name;
    recording.tick_s = rig.tick_s;
    recording.columns = {.macro_command = true, .encoder = true};
    for (int tick = 0; tick < 1000; ++tick) {
        const double time_s = tick * rig.tick_s, command_V = 4.5 * std::sin(4.0 * M_PI * time_s);
        const plant::StageReading reading = plant::sample(plant, state);
        recording.rows.push_back({.time_ns = std::llround(time_s * 1e9),
                                  .macro_command_V = command_V,
                                  .encoder_count = static_cast<double>(reading.encoder_count)});
        plant::advance(plant, state, command_V, 0.0);
    }
    return recording;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) {
        std::fprintf(stderr, "usage: 06_recording RIG.yaml FOLDER\n");
        return 2;
    }
    try {
        write_recording(argv[2], record(load_rig(argv[1])), std::nullopt);
        const Recording read = read_recording(argv[2]);
        std::printf("%s: %zu rows of %.3f s; the encoder went from %.0f to %.0f counts\n", argv[2],
                    read.rows.size(), read.tick_s, read.rows.front().encoder_count,
                    read.rows.back().encoder_count);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "06_recording: %s\n", error.what());
        return 2;
    }
}
