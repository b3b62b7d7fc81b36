// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The carriage's motion where it has no closed form: forces by position, friction on the motion, a belt,
// play.
//
//     w = drive + f(y),  V = V(w)       standing forces (plant/standing_force.h), dead zone
//     tau dv/dt = K (V - F) - v         friction (plant/friction.h); belt: plant/transmission.h
//
// Between events the right-hand side is smooth, and an embedded Runge-Kutta pair integrates it, with steps
// controlled to the tolerances in plant/motion_error.h; where all forces are linear, a whole step without an
// event has an exact solution (plant/affine_step.h), and where all but those by position are, the motion is a
// power series (plant/motion_series.h). Events are located within the tick: the velocity's zero (turn, stop)
// where friction or play makes it one, an edge of the dead zone, an end of travel, break-away. A carriage
// held by friction stays exactly where it is, without chattering.
#include "plant/affine_step.h"

#include <array>

namespace fidservo::plant {

struct MacroAxis;
struct MacroAxisState;

/// What effects add to the state of the carriage; all zero without effects.
struct MechanismState {
    double play_mm = 0.0;              ///< position of the carriage minus that of the driving part
    double driven_mm_per_s = 0.0;      ///< velocity of the driving part, where there is play
    double stretch_mm = 0.0;           ///< stretch of the belt: motor minus carriage
    double stretching_mm_per_s = 0.0;  ///< rate of the belt's stretch
    double bristle_bend = 0.0;         ///< z of plant/friction.h, -1 .. 1
};

/// The matrix G of a whole step for each mode in which an axis can move: by branch of the dead zone,
/// direction, and whether friction holds the carriage. With 2 states only the upper left corner is used.
struct WholeSteps {
    double duration_s = 0.0;  ///< 0: forces are nowhere linear, so there are no matrices
    std::array<SquareMatrix<4>, 12> of_way{};
};

/// The matrices for an axis of which everything else has been made.
WholeSteps whole_steps(const MacroAxis& axis);

/// The number of steps that a motion took.
struct StepCount {
    int integrated = 0;  ///< Runge-Kutta steps, rejected ones included
    int in_series = 0;

    StepCount& operator+=(const StepCount& more) {
        integrated += more.integrated;
        in_series += more.in_series;
        return *this;
    }
};

/// Whether the motion is a power series wherever dry friction is constant.
bool has_series(const MacroAxis& axis);

/// Limit that keeps a thousand ticks, the length of a prediction window, to a second of computing: a step
/// takes 0.2 us.
inline constexpr int most_steps_a_tick = 5000;

/// Moves the carriage under a held voltage of the drive, before standing forces and dead zone. Does not
/// allocate. Throws InputError where forces are so stiff that more than most_steps_a_tick steps would be
/// needed.
StepCount move(const MacroAxis& axis, MacroAxisState& state, double drive_V, double duration_s);

}  // namespace fidservo::plant
