// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Recordings of a slow carriage without dead zone, made by the independent model of rigs.
#include "core/recording.h"
#include "core/rig.h"
#include "src/identify/identify.h"
#include "tests/calib/macro_drive.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace fidservo::testing {

/// A carriage without dead zone, and forces that its model lacks.
struct Carriage {
    double gain_mm_per_s_per_V = 40.0;
    double time_constant_s = 0.08;
    double friction_V = 0.5;
    double offset_V = 0.05;
    reference::Departures other = {};
};

inline constexpr double slow_tick_s = 0.01, fine_mm = 0.001;

/// Its rig file, at 100 Hz.
inline Rig rig_of(const Carriage& carriage) {
    Rig rig = calib::direct_rig(fine_mm);
    rig.tick_s = slow_tick_s;
    rig.macro.velocity_gain_mm_per_s_per_V = carriage.gain_mm_per_s_per_V;
    rig.macro.velocity_pole = std::exp(-slow_tick_s / carriage.time_constant_s);
    rig.macro.low_mm = -1000.0;
    rig.macro.high_mm = 1000.0;
    return rig;
}

/// Driven from rest, with white noise of the encoder.
inline Recording recorded(const Carriage& carriage, const std::string& name, const calib::Volts& volts,
                          double duration_s, std::mt19937_64& random, double noise_mm = 0.01) {
    Rig rig = rig_of(carriage);
    reference::Departures departures = carriage.other;
    departures.friction.coulomb_V += carriage.friction_V;
    departures.drive.offset_V += carriage.offset_V;
    const calib::MacroTrace trace = calib::drive(rig, volts, duration_s, 0.0, departures);
    Recording recording;
    recording.name = name;
    recording.rig = rig.name;
    recording.tick_s = slow_tick_s;
    recording.columns.macro_command = recording.columns.position = true;
    std::normal_distribution<double> noise(0.0, noise_mm);
    for (std::size_t k = 0; k < trace.command_V.size(); ++k) {
        StageRow row;
        row.time_ns = nanoseconds(static_cast<double>(k) * slow_tick_s);
        row.macro_command_V = trace.command_V[k];
        row.position_mm = trace.position_mm[k] + noise(random);
        recording.rows.push_back(row);
    }
    return recording;
}

/// Pulses of drawn size to both sides, each of 0.3 s in 0.6 s: the carriage reverses and coasts.
inline calib::Volts drawn_pulses(std::mt19937_64& random, double duration_s) {
    std::uniform_real_distribution<double> size(1.5, 4.0);
    std::vector<double> volts;
    for (int i = 0; i * 0.6 < duration_s; ++i) volts.push_back((i % 2 == 0 ? 1.0 : -1.0) * size(random));
    return calib::pulses(volts, 0.6, 0.3);
}

inline const IdentifiedValue* find_value(const Identified& identified, const std::string& key) {
    const auto found = std::ranges::find(identified.values, key, &IdentifiedValue::key);
    return found == identified.values.end() ? nullptr : &*found;
}

/// The true values of the numbers that an identification states.
inline std::vector<std::pair<std::string, double>> truth_of(const Carriage& carriage) {
    return {{"macro.velocity_gain_mm_per_s_per_V", carriage.gain_mm_per_s_per_V},
            {"time_constant", carriage.time_constant_s},
            {"coulomb_friction", carriage.friction_V},
            {"drive_offset", carriage.offset_V}};
}

}  // namespace fidservo::testing
