// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// An experiment as numbers that a search may change: pieces of voltage or setpoint for either stage.
#include "src/simulation/experiments.h"
#include "src/simulation/pieces.h"

#include <cstdint>
#include <string>
#include <vector>

namespace fidservo {
struct Rig;
}

namespace fidservo::design {

/// No designed experiment lasts longer.
inline constexpr double longest_s = 30.0;

enum class Shape : std::uint8_t { constant, ramp, sine };

/// A piece of an experiment file (docs/formats.md), in V or in mm of a setpoint.
struct DesignedPiece {
    Follows follows = Follows::voltage;
    Shape shape = Shape::constant;
    double duration_s = 0.0;
    double value = 0.0;         ///< of a constant; where a ramp begins; about which a sine swings
    double end = 0.0;           ///< of a ramp
    double amplitude = 0.0;     ///< of a sine
    double frequency_hz = 0.0;  ///< likewise
    bool is_rest = false;       ///< its value is given, only its duration may change

    bool operator==(const DesignedPiece&) const = default;
};

struct Design {
    double carriage_mm = 0.0;  ///< at the start
    std::vector<DesignedPiece> macro, micro;

    bool operator==(const Design&) const = default;
};

/// The longer one of the two stages' sequences.
double duration_s(const Design& design);

/// With values and times as an experiment file states them: whole ticks, 0.1 mV, 1 um, 1 uHz; within what
/// the stages can be told, and cut off after longest_s. Pieces that vanish are left out.
Design rounded(Design design, const Rig& rig);

/// The text of an experiment file (docs/formats.md).
/// @param design  rounded
/// @param name    of letters, digits, -, _ and ., 60 at most
/// @param remark  lines at its head, without the mark of a comment
std::string experiment_yaml(const Design& design, const std::string& name,
                            const std::vector<std::string>& remark = {});

/// What the file says, read as `record` reads it. Throws InputError where it would be refused.
/// @param design  rounded
Experiment experiment_of(const Design& design, const std::string& name, const Rig& rig);

/// What may be changed, each as a share of what the rig allows, 0 to 1: where the carriage begins, how long
/// each piece lasts (20 ms to 30 s) and how often a sine swings (0.05 to 10 Hz), both by their logarithms,
/// and the values.
std::vector<double> numbers(const Design& design, const Rig& rig);

/// The same pieces with other numbers; rounded.
Design with_numbers(Design form, const std::vector<double>& shares, const Rig& rig);

}  // namespace fidservo::design
