// SPDX-License-Identifier: GPL-3.0-or-later
// The hysteresis loop of the shape-memory-alloy wire by its Preisach model, with a minor loop inside, and the
// inverse of the model.
//
//     03_wire_loop RIG.yaml
#include "core/input_error.h"
#include "core/preisach.h"
#include "core/rig.h"
#include "src/files/rig/rig_file.h"

#include <cstdio>

namespace {

using namespace fidservo;

void heat_or_cool(const FodTable& table, PreisachMemory& wire, double to_degC, double steps) {
    const double from_degC = wire.temp_degC;
    for (int k = 1; k <= steps; ++k) {
        const double temp_degC = from_degC + (to_degC - from_degC) * k / steps;
        const double contraction_mm = preisach_step(table, wire, temp_degC);
        std::printf("  %6.1f degC   %.4f mm   %zu turns remembered\n", temp_degC, contraction_mm,
                    wire.loops.size());
    }
}

void loop(const char* rig_file) {
    const Rig rig = load_rig(rig_file);
    if (!rig.micro) throw InputError(std::string(rig_file) + ": micro: missing; the wire belongs to it");
    const FodTable& table = *rig.micro->fod;

    PreisachMemory wire = preisach_start(table, table.low_degC());
    const double span_degC = table.high_degC() - table.low_degC();
    heat_or_cool(table, wire, table.low_degC() + 0.6 * span_degC, 4);
    heat_or_cool(table, wire, table.low_degC() + 0.4 * span_degC, 3);  // a minor loop begins
    heat_or_cool(table, wire, table.low_degC() + 0.5 * span_degC, 2);
    heat_or_cool(table, wire, table.high_degC(), 3);  // and is wiped out
    heat_or_cool(table, wire, table.low_degC(), 4);

    const double wanted_mm = 0.5 * table.stroke_mm();
    if (const auto temp_degC = preisach_inverse(table, wire, wanted_mm))
        std::printf("half the stroke, %.4f mm: heat to %.2f degC\n", wanted_mm, *temp_degC);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: 03_wire_loop RIG.yaml\n");
        return 2;
    }
    try {
        loop(argv[1]);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "03_wire_loop: %s\n", error.what());
        return 2;
    }
}
