// SPDX-License-Identifier: GPL-3.0-or-later
// A fiducial-relative move on the simulated rig: the camera beside a tag, as it measures itself.
//
//     04_go_to_tag RIG.yaml TAG DX_UM
#include "core/input_error.h"
#include "core/rig.h"
#include "src/files/rig/plate_file.h"
#include "src/files/rig/rig_file.h"
#include "src/session/session.h"

#include <cstdio>
#include <cstdlib>

namespace {

void move(const char* rig_file, int tag_id, double dx_um) {
    using namespace fidservo;
    const Rig rig = load_rig(rig_file);
    if (!rig.fiducials)
        throw InputError(std::string(rig_file) + ": fiducials: missing; a tag is where to go");
    const Plate plate = plate_of(*rig.fiducials);

    // stage and camera are "sim" unless the options say otherwise: comedi:/dev/comedi0, v4l2:/dev/video0.
    SessionOptions options;
    options.rig_file = rig_file;
    Session session(options, rig, plate, plate);

    if (const Status homed = session.home(); !homed) throw RunFault(homed.error().text);
    std::printf("homed after %.1f s of the rig's time\n", session.elapsed_s());
    const Result<Arrival> arrival = session.go_to(tag_id, dx_um / 1000.0);
    if (!arrival) throw RunFault(arrival.error().text);
    std::printf("tag %d %+.1f um: reached %+.3f +- %.3f um in %.2f s with %d moves of the micro stage\n",
                tag_id, dx_um, arrival->reached_dx_um, arrival->reached_std_um,
                arrival->macro_time_s + arrival->micro_time_s, arrival->micro_moves);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 4) {
        std::fprintf(stderr, "usage: 04_go_to_tag RIG.yaml TAG DX_UM\n");
        return 2;
    }
    try {
        move(argv[1], std::atoi(argv[2]), std::atof(argv[3]));
    } catch (const std::exception& error) {
        std::fprintf(stderr, "04_go_to_tag: %s\n", error.what());
        return 2;
    }
}
