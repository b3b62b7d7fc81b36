// SPDX-License-Identifier: GPL-3.0-or-later
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
// Effects add to that a delay of the command (plant/delay_line.h) and a voltage of the drive by a formula,
// which keep the exact solution; and forces by position, friction on the motion, a belt, play and forces by
// formulas (plant/mechanism.h), which are integrated.
#include "core/macro_parameters.h"
#include "plant/delay_line.h"
#include "plant/formulas/formulas.h"
#include "plant/friction.h"
#include "plant/mechanism.h"
#include "plant/standing_force.h"
#include "plant/transmission.h"

#include <algorithm>
#include <array>

namespace fidservo {
struct Rig;
}

namespace fidservo::plant {

/// All numbers of the axis, open to changes by effects.
struct MacroAxisParameters {
    double low_mm = 0.0;           ///< travel; may be infinite
    double high_mm = 0.0;          ///< upper end of the travel
    double command_limit_V = 0.0;  ///< largest command either way
    double drive_gain = 1.0;       ///< of the amplifier
    double drive_bias_V = 0.0;     ///< a force that also acts on the carriage at rest, held by the dead zone
    DeadZone dead_zone;            ///< what friction leaves of a voltage
    double dead_zone_on_motion = 0.0;           ///< share of it that is dry friction on the motion
    double velocity_gain_mm_per_s_per_V = 0.0;  ///< K
    double time_constant_s = 0.0;               ///< tau

    double delay_s = 0.0;      ///< of the command
    StandingForce standing{};  ///< forces by position
    Friction friction{};       ///< friction on the motion
    Belt belt{};               ///< between drive and carriage
    double play_mm = 0.0;      ///< width, from one side to the other
    Formulas formulas{};       ///< at the ports of the carriage
};

/// What formulas see of a carriage beside its motion, and what they remember.
struct CarriageFormulaState {
    double time_s = 0.0;     ///< of the tick's beginning
    double way_mm = 0.0;     ///< covered until then, whichever way it went
    double command_V = 0.0;  ///< that acts, after saturation
    FormulaMemory memory{};  ///< what formulas remember
};

/// Position in the stage frame, velocity positive to the right.
struct MacroAxisState {
    double position_mm = 0.0;         ///< in the stage's frame
    double velocity_mm_per_s = 0.0;   ///< positive to the right
    MechanismState mechanism{};       ///< of belt, play and bristles
    DelayLineState delay{};           ///< of the command, from `start`; empty without delay
    CarriageFormulaState formulas{};  ///< what formulas see and remember
};

/// Parameters and what follows from them for one tick. Immutable.
struct MacroAxis {
    MacroAxisParameters parameters;  ///< as they were given
    double tick_s = 0.0;             ///< T
    double decay = 0.0;              ///< exp(-T / tau)
    double glide_s = 0.0;            ///< tau (1 - decay): way per unit of velocity in excess of K V

    bool has_closed_form = true;        ///< none of what follows
    bool has_standing_force = false;    ///< a force acts by position
    bool has_friction = false;          ///< there is friction on the motion
    bool has_force_formula = false;     ///< contained in has_standing_force
    bool has_friction_formula = false;  ///< contained in has_friction
    bool has_bristles = false;          ///< friction has bristles that bend
    bool turns_matter = false;          ///< forces change, or play begins, where the carriage turns round
    bool has_belt = false;              ///< drive and carriage are not one
    BeltForce belt{};                   ///< what follows from the belt's numbers
    double driven_low_mm = 0.0;         ///< travel of what drives the carriage: wider by the play
    double driven_high_mm = 0.0;        ///< its upper end
    double longest_step_s = 0.0;        ///< of the integration
    WholeSteps whole_steps{};           ///< what follows for a tick that is followed in whole
    bool has_series = false;            ///< motion is a power series
};

/// The axis of a rig, without effects. tau = -T / ln(pole).
MacroAxisParameters macro_axis_parameters(const Rig& rig);

/// Throws InputError where the damping of a direction is not positive: the carriage would run away.
MacroAxis make_macro_axis(const MacroAxisParameters& parameters, double tick_s);

/// The carriage at rest at a position, in the middle of its play; the command was 0 before.
MacroAxisState start(const MacroAxis& axis, double position_mm);

/// A carriage on its way, as formulas see it.
struct CarriageSight {
    /// In the stage's frame.
    double place_mm, speed_mm_per_s;
    double direction;        ///< 1 or -1; of a carriage at rest, where it is pulled
    double voltage_V = 0.0;  ///< what the dead zone leaves of drive and forces
};

/// The variables of formulas at a carriage, in the order of plant/formulas/port.h.
std::array<double, carriage_variable::count> formula_variables(const CarriageFormulaState& seen,
                                                               const CarriageSight& sight);

/// What the formulas at a port of the carriage come to, V.
inline double formula_V(const Formulas& formulas, const CarriageFormulaState& seen, Port port,
                        const CarriageSight& sight) {
    return formulas.value(port, formula_variables(seen, sight), seen.memory);
}

/// A command within the drive's range, V.
inline double saturated_V(const MacroAxisParameters& parameters, double command_V) {
    return std::clamp(command_V, -parameters.command_limit_V, parameters.command_limit_V);
}

/// What the drive puts out, in V: the amplified command, without forces on the carriage.
double drive_voltage_V(const MacroAxisParameters& parameters, double command_V);

/// The voltage V that is left for motion of a command u, both in V, without forces by position.
double effective_voltage_V(const MacroAxisParameters& parameters, double command_V);

/// Moves the carriage by one tick under a held command in V.
/// @return what that took; nothing where there was an exact solution
StepCount advance(const MacroAxis& axis, MacroAxisState& state, double command_V);

}  // namespace fidservo::plant
