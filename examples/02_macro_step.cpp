// SPDX-License-Identifier: GPL-3.0-or-later
// A step of the macro stage, simulated: a voltage into the carriage, its speed and place out.
//
//     02_macro_step RIG.yaml
#include "core/rig.h"
#include "plant/macro_axis.h"
#include "src/files/rig/rig_file.h"

#include <cmath>
#include <cstdio>
#include <exception>

namespace {

void step(const char* rig_file) {
    using namespace fidservo;
    const Rig rig = load_rig(rig_file);
    const plant::MacroAxisParameters parameters = plant::macro_axis_parameters(rig);
    const plant::MacroAxis axis = plant::make_macro_axis(parameters, rig.tick_s);

    // tau dv/dt = K V - v, where V is what the dead zone leaves of the command.
    const double command_V = 0.9 * parameters.command_limit_V, tau_s = parameters.time_constant_s;
    const double effective_V = plant::effective_voltage_V(parameters, command_V);
    const double last_mm_per_s = parameters.velocity_gain_mm_per_s_per_V * effective_V;

    plant::MacroAxisState state = plant::start(axis, parameters.low_mm);
    std::printf("    t [s]   y [mm]   v [mm/s]   v by the equation [mm/s]\n");
    for (int tick = 0; tick <= 120; ++tick) {
        const double time_s = tick * rig.tick_s;
        if (tick % 20 == 0)
            std::printf("  %7.3f  %7.3f   %8.3f   %8.3f\n", time_s, state.position_mm,
                        state.velocity_mm_per_s, last_mm_per_s * (1.0 - std::exp(-time_s / tau_s)));
        plant::advance(axis, state, command_V);
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: 02_macro_step RIG.yaml\n");
        return 2;
    }
    try {
        step(argv[1]);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "02_macro_step: %s\n", error.what());
        return 2;
    }
}
