// SPDX-License-Identifier: GPL-3.0-or-later
// A stage of one's own behind the Stage boundary: a microcontroller at the end of a wire, in place of a
// Comedi board. The session homes it and moves it to a tag as any other.
//
//     08_own_stage RIG.yaml
#include "core/input_error.h"
#include "core/rig.h"
#include "src/files/rig/plate_file.h"
#include "src/files/rig/rig_file.h"
#include "src/session/session.h"
#include "src/session/simulated_rig.h"
#include "wired_stage.h"

#include <cstdio>

namespace {

using namespace fidservo;

/// What stands at the other end of the wire here: the simulated rig, which the camera sees too.
std::string microcontroller(SimulatedRig& rig, const std::string& line) {
    control::StageCommand command;
    if (std::sscanf(line.c_str(), "w %lf %lf", &command.macro_V, &command.micro_V) == 2)
        return rig.write(command), "ok";
    const control::StageSample sample = rig.read();
    return std::to_string(sample.time_ns) + " " + std::to_string(sample.encoder_count) + " " +
           std::to_string(sample.hall_adc);
}

void move(const char* rig_file) {
    const Rig rig = load_rig(rig_file);
    if (!rig.fiducials || !rig.camera)
        throw InputError(std::string(rig_file) + ": no camera, or no fiducials");
    const Plate plate = plate_of(*rig.fiducials);
    const auto machine = std::make_shared<SimulatedRig>(plant::plant_parameters(rig), *rig.camera, plate, 1);
    const auto stage = std::make_shared<WiredStage>(
        [&](const std::string& line) { return microcontroller(*machine, line); });
    Session session({.rig_file = rig_file}, rig, plate,
                    Devices{stage, std::make_shared<SimulatedCamera>(machine)});
    if (const Status homed = session.home(); !homed) throw RunFault(homed.error().text);
    const Result<Arrival> arrival = session.go_to(3, 0.25);
    if (!arrival) throw RunFault(arrival.error().text);
    std::printf("reached %+.3f um beside tag %d\n", arrival->reached_dx_um, arrival->tag_id);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: 08_own_stage RIG.yaml\n");
        return 2;
    }
    try {
        move(argv[1]);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "08_own_stage: %s\n", error.what());
        return 2;
    }
}
