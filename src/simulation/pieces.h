// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A course made of pieces that follow each other: constants, ramps and sines are one formula,
//
//     value(t) = base + per_s t + amplitude sin(omega t + phase),     t from the start of the piece.
#include "src/simulation/experiments.h"

#include <utility>
#include <vector>

namespace fidservo {

enum class Follows { voltage, setpoint };

/// Its values are in V, or in mm of a setpoint.
struct Piece {
    Follows follows = Follows::voltage;
    double duration_s = 0.0;
    double base = 0.0, per_s = 0.0;
    double amplitude = 0.0, omega_rad_per_s = 0.0, phase_rad = 0.0;
};

double value_at(const Piece& piece, double t_s);

/// The lowest and the highest value that a piece takes.
std::pair<double, double> extremes(const Piece& piece);

double duration_s(const std::vector<Piece>& pieces);

/// The function composed of those pieces that have the kind asked for, in force during them; empty if there
/// are none.
Course course_of(const std::vector<Piece>& pieces, Follows follows);

}  // namespace fidservo
