// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Start points of a search for a better experiment.
#include "core/random.h"
#include "src/design/design.h"

#include <optional>
#include <vector>

namespace fidservo::design {

/// An experiment of the list as pieces: constants, or one sine; cut off after longest_s. Empty where it is
/// made of other pieces, or moves nothing.
std::optional<Design> as_design(const Experiment& experiment, const Rig& rig);

/// How often each stage is to be moved.
struct Emphasis {
    bool macro = true, micro = true;
};

/// A random sequence of pieces of several kinds with random numbers. For the carriage: pulses to either side,
/// sines, steps and ramps of the setpoint over the travel or around a place, setpoints and pulses in turn, or
/// rest; for the platform: heating and cooling, triangles of voltage, steps, ramps and sines of the setpoint,
/// a constant heat, or rest. Lasts 20 to 30 s. Pieces for which the rig has no controller are not drawn.
Design drawn_design(const Rig& rig, const Emphasis& emphasis, NoiseStream& draw);

}  // namespace fidservo::design
