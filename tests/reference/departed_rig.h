// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The reference rig with departures, as it moves from rest.
#include "core/rig.h"
#include "reference/reference_rig.h"
#include "src/files/rig/rig_file.h"

namespace fidservo::reference::testing {

inline Rig rig() {
    return load_rig(FIDSERVO_ASSETS_DIR "/rig.yaml");
}

inline double gain() {
    return rig().macro.velocity_gain_mm_per_s_per_V;
}

inline State after(const RigModel& model, State state, int ticks, double macro_V, double micro_V = 0.0) {
    for (int k = 0; k < ticks; ++k) advance(model, state, macro_V, micro_V);
    return state;
}

/// The state after a motion from rest, with the carriage at 30 mm at the start.
inline State from_rest(const Departures& departures, int ticks, double macro_V, double micro_V = 0.0) {
    const RigModel model = make_rig_model(rig(), departures);
    return after(model, start(model, 30.0, 1), ticks, macro_V, micro_V);
}

}  // namespace fidservo::reference::testing
