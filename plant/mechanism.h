#pragma once
// The carriage's motion where it has no closed form: forces by position, friction on the motion, a belt,
// play.
//
//     w = drive + f(y),  V = V(w)       standing forces (plant/standing_force.h), dead zone
//     tau dv/dt = K (V - F) - v         friction (plant/friction.h); belt: plant/transmission.h
//
// Between events the right-hand side is smooth, and an embedded Runge-Kutta pair integrates it, its steps
// kept to the tolerances in mechanism.cpp. Events are located within the tick: the velocity's zero (turn,
// stop), an edge of the dead zone, an end of travel, break-away. What is held stays exactly where it is;
// nothing chatters.
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

/// Moves the carriage under a held voltage of the drive, before standing forces and dead zone. Does not
/// allocate.
void move(const MacroAxis& axis, MacroAxisState& state, double drive_V, double duration_s);

}  // namespace fidservo::plant
