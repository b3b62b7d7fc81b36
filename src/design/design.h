// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// An experiment as numbers that a search can change: pieces of voltage or setpoint for either stage.
#include "src/simulation/experiments.h"
#include "src/simulation/pieces.h"

#include <cstdint>
#include <string>
#include <vector>

namespace fidservo {
struct Rig;
}

namespace fidservo::design {

/// Longest duration of a designed experiment.
inline constexpr double longest_s = 30.0;

enum class Shape : std::uint8_t { constant, ramp, sine };

/// A piece of an experiment file (docs/formats.md), in V or in mm of a setpoint.
struct DesignedPiece {
    Follows follows = Follows::voltage;
    Shape shape = Shape::constant;
    double duration_s = 0.0;
    double value = 0.0;         ///< value of a constant; a ramp's start; a sine's mean
    double end = 0.0;           ///< end value of a ramp
    double amplitude = 0.0;     ///< amplitude of a sine
    double frequency_hz = 0.0;  ///< frequency of a sine
    bool is_rest = false;       ///< its value is fixed; only its duration may change

    bool operator==(const DesignedPiece&) const = default;
};

struct Design {
    double carriage_mm = 0.0;  ///< carriage position at the start
    std::vector<DesignedPiece> macro, micro;

    bool operator==(const Design&) const = default;
};

/// Duration of the longer one of the two stages' sequences.
double duration_s(const Design& design);

/// The design with values and times rounded as in an experiment file: whole ticks, 0.1 mV, 1 um, 1 uHz;
/// limited to the stages' ranges, and cut off after longest_s. Pieces without duration are left out.
Design rounded(Design design, const Rig& rig);

/// The text of an experiment file (docs/formats.md).
/// @param design  rounded
/// @param name    of letters, digits, -, _ and ., 60 at most
/// @param remark  comment lines at its head, without the comment sign
std::string experiment_yaml(const Design& design, const std::string& name,
                            const std::vector<std::string>& remark = {});

/// The experiment that `record` reads from that file. Throws InputError where it would be refused.
/// @param design  rounded
Experiment experiment_of(const Design& design, const std::string& name, const Rig& rig);

/// The numbers that may be changed, each as a fraction of the rig's range, 0 to 1: where the carriage begins,
/// the duration of each piece (20 ms to 30 s) and the frequency of each sine (0.05 to 10 Hz), both on a
/// logarithmic scale, and the values.
std::vector<double> numbers(const Design& design, const Rig& rig);

/// The same pieces with other numbers; rounded.
Design with_numbers(Design form, const std::vector<double>& shares, const Rig& rig);

}  // namespace fidservo::design
