// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Experiments from which a search for a better one begins.
#include "core/random.h"
#include "src/design/design.h"

#include <optional>
#include <vector>

namespace fidservo::design {

/// An experiment of the list as pieces: constants, or one sine; cut off after longest_s. Nothing where it is
/// made of anything else, or moves nothing.
std::optional<Design> as_design(const Experiment& experiment, const Rig& rig);

/// Which stages it is to move most often.
struct Emphasis {
    bool macro = true, micro = true;
};

/// Pieces of some kinds in an order, numbers and values drawn: of the carriage pulses to either side, sines,
/// steps and ramps of the setpoint over the travel or around a place, setpoints and pulses in turn, or rest;
/// of the platform heating and cooling, triangles of voltage, steps, ramps and sines of the setpoint, a
/// constant heat, or rest. Lasts 20 to 30 s. What the rig has no controller for is not drawn.
Design drawn_design(const Rig& rig, const Emphasis& emphasis, NoiseStream& draw);

}  // namespace fidservo::design
