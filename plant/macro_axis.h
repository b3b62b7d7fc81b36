#pragma once
// The macro stage: a printer carriage behind a saturated drive and a dead zone that stands for its friction.
//
//     w = g clamp(u, -limit, limit) + b                        drive: gain g, force on the carriage b (V)
//     V = sgn(w) (a0 + d (|w| - w0))  for |w| >= w0, else 0     dead zone
//     tau dv/dt = K V - v,   dy/dt = v                          carriage
//
// The command is held over a tick, so the motion has an exact solution. At either end of travel the carriage
// stops dead. Friction acts at the input only: without effective voltage the carriage coasts to rest.
//
// Effects add to that a delay of the command (plant/delay_line.h), which keeps the exact solution; and
// forces by position, friction on the motion, a belt and play (plant/mechanism.h), which are integrated.
#include "core/macro_parameters.h"
#include "plant/delay_line.h"
#include "plant/friction.h"
#include "plant/mechanism.h"
#include "plant/standing_force.h"
#include "plant/transmission.h"

namespace fidservo {
struct Rig;
}

namespace fidservo::plant {

struct MacroAxisParameters {
    double low_mm = 0.0;  ///< travel; may be infinite
    double high_mm = 0.0;
    double command_limit_V = 0.0;
    double drive_gain = 1.0;    ///< of the amplifier
    double drive_bias_V = 0.0;  ///< a force that also acts on the carriage at rest, held by the dead zone
    DeadZone dead_zone;
    double dead_zone_on_motion = 0.0;  ///< share of it that is dry friction on the motion
    double velocity_gain_mm_per_s_per_V = 0.0;
    double time_constant_s = 0.0;

    double delay_s = 0.0;  ///< of the command
    StandingForce standing{};
    Friction friction{};
    Belt belt{};
    double play_mm = 0.0;  ///< width, from one side to the other
};

/// Position in the stage frame, velocity positive to the right.
struct MacroAxisState {
    double position_mm = 0.0;
    double velocity_mm_per_s = 0.0;
    MechanismState mechanism{};
    DelayLineState delay{};  ///< of the command, from `start`; empty without delay
};

/// Parameters and what follows from them for one tick. Immutable.
struct MacroAxis {
    MacroAxisParameters parameters;
    double tick_s = 0.0;
    double decay = 0.0;    ///< exp(-T / tau)
    double glide_s = 0.0;  ///< tau (1 - decay): way per unit of velocity in excess of K V

    bool has_closed_form = true;  ///< none of what follows
    bool has_standing_force = false;
    bool has_friction = false;
    bool has_bristles = false;
    bool has_belt = false;
    BeltForce belt{};
    double driven_low_mm = 0.0;  ///< travel of what drives the carriage: wider by the play
    double driven_high_mm = 0.0;
    double longest_step_s = 0.0;  ///< of the integration
    WholeSteps whole_steps{};
    bool has_series = false;  ///< motion is a power series
};

/// The axis of a rig, without effects. tau = -T / ln(pole).
MacroAxisParameters macro_axis_parameters(const Rig& rig);

/// Throws InputError where the damping of a direction is not positive: the carriage would run away.
MacroAxis make_macro_axis(const MacroAxisParameters& parameters, double tick_s);

/// The carriage at rest at a position, in the middle of its play; the command was 0 before.
MacroAxisState start(const MacroAxis& axis, double position_mm);

/// What the drive puts out, in V: the amplified command, without forces on the carriage.
double drive_voltage_V(const MacroAxisParameters& parameters, double command_V);

/// The voltage V that is left for motion of a command u, both in V, without forces by position.
double effective_voltage_V(const MacroAxisParameters& parameters, double command_V);

/// Moves the carriage by one tick under a held command in V.
/// @return what that took; nothing where there was an exact solution
StepCount advance(const MacroAxis& axis, MacroAxisState& state, double command_V);

}  // namespace fidservo::plant
