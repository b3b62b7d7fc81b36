// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The carriage's motion where it has no closed form: forces by position, friction on the motion, a belt,
// play.
//
//     w = drive + f(y),  V = V(w)       standing forces (plant/standing_force.h), dead zone
//     tau dv/dt = K (V - F) - v         friction (plant/friction.h); belt: plant/transmission.h
//
// Between events the right-hand side is smooth, and an embedded Runge-Kutta pair integrates it, its steps
// kept to the tolerances in plant/motion.h; where all forces are straight lines, a whole step without an
// event has an exact solution (plant/affine_step.h), and where all but those by position are, the motion is a
// power series (plant/motion_series.h). Events are located within the tick: the velocity's zero (turn, stop)
// where friction or play makes it one, an edge of the dead zone, an end of travel, break-away. What is held
// stays exactly where it is; nothing chatters.
#include "plant/affine_step.h"

#include <array>

namespace fidservo::plant {

struct MacroAxis;
struct MacroAxisState;

/// What effects add to the state of the carriage: all zero where there are none.
struct MechanismState {
    double play_mm = 0.0;              ///< carriage minus what drives it
    double driven_mm_per_s = 0.0;      ///< velocity of what drives it, where there is play
    double stretch_mm = 0.0;           ///< of the belt: motor minus carriage
    double stretching_mm_per_s = 0.0;  ///< its rate
    double bristle_bend = 0.0;         ///< z of plant/friction.h, -1 .. 1
};

/// G of a whole step for each way in which an axis can move: by branch of the dead zone, direction, and
/// whether friction holds the carriage. Of 2 states the upper left
/// corner counts.
struct WholeSteps {
    double duration_s = 0.0;  ///< 0: forces are nowhere straight lines
    std::array<SquareMatrix<4>, 12> of_way{};
};

/// Of an axis that is otherwise made.
WholeSteps whole_steps(const MacroAxis& axis);

/// What it took to move.
struct StepCount {
    int integrated = 0;  ///< those that were given up included
    int in_series = 0;

    StepCount& operator+=(const StepCount& more) {
        integrated += more.integrated;
        in_series += more.in_series;
        return *this;
    }
};

/// Whether motion is a power series where dry friction does not change.
bool has_series(const MacroAxis& axis);

/// So that a thousand ticks, a window of what is predicted, take a second at most: a step takes 0.2 us.
inline constexpr int most_steps_a_tick = 5000;

/// Moves the carriage under a held voltage of the drive, before standing forces and dead zone. Does not
/// allocate. Throws InputError where forces are so stiff that it would take more than most_steps_a_tick.
StepCount move(const MacroAxis& axis, MacroAxisState& state, double drive_V, double duration_s);

}  // namespace fidservo::plant
