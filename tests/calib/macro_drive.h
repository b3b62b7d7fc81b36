// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Recordings of a macro stage for tests, made by the independent model of rigs, so that no fit is compared
// with its own model.
#include "calib/macro/macro_identification.h"
#include "core/random.h"
#include "reference/reference_rig.h"
#include "src/files/rig/rig_file.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace fidservo::calib {

/// The reference rig, reduced to what identification of the macro stage uses.
inline Rig macro_rig() {
    Rig rig = load_rig(FIDSERVO_ASSETS_DIR "/rig.yaml");
    rig.micro.reset();
    rig.camera.reset();
    rig.fiducials.reset();
    return rig;
}

/// The same carriage with neither dead zone nor coarse encoder.
inline Rig direct_rig(double resolution_mm = 0.001) {
    Rig rig = macro_rig();
    rig.macro.dead_zone = {};
    rig.macro.velocity_gain_mm_per_s_per_V = 40.0;
    rig.macro.encoder_resolution_mm = resolution_mm;
    return rig;
}

using Volts = std::function<double(double t_s)>;

/// Commands over time from rest, open loop.
inline MacroTrace drive(const Rig& rig, const Volts& volts, double duration_s, double start_mm,
                        const reference::Departures& departures = {}) {
    const reference::RigModel model = reference::make_rig_model(rig, departures);
    reference::State state = reference::start(model, start_mm, 1);
    MacroTrace trace{"driven", rig.tick_s, {}, {}};
    const auto ticks = static_cast<int>(std::lround(duration_s / rig.tick_s));
    for (int k = 0; k < ticks; ++k) {
        const double u =
            std::clamp(volts(k * rig.tick_s), -rig.macro.command_limit_V, rig.macro.command_limit_V);
        trace.position_mm.push_back(static_cast<double>(reference::sample(model, state).encoder_count) *
                                    rig.macro.encoder_resolution_mm);
        trace.command_V.push_back(u);
        reference::advance(model, state, u, 0.0);
    }
    return trace;
}

/// 0 V until 50 ms, then a constant command.
inline Volts step_to(double volts) {
    return [=](double t_s) { return t_s < 0.0495 ? 0.0 : volts; };
}

/// Pulses of the given voltages, each `length_s` long, one every `period_s`, from rest to rest.
inline Volts pulses(std::vector<double> volts, double period_s = 0.5, double length_s = 0.15) {
    return [=](double t_s) {
        const auto i = static_cast<std::size_t>((t_s + 1e-9) / period_s);
        return i < volts.size() && t_s + 1e-9 - static_cast<double>(i) * period_s < length_s ? volts[i] : 0.0;
    };
}

/// Rising DC steps from `first_V` on, each `length_s` long and followed by a rest of the same length.
inline Volts rising_steps(double first_V, double rise_V, double length_s = 0.1) {
    return [=](double t_s) {
        const double i = std::floor((t_s + 1e-9) / (2.0 * length_s));
        return t_s + 1e-9 - 2.0 * length_s * i < length_s ? first_V + rise_V * i : 0.0;
    };
}

}  // namespace fidservo::calib
