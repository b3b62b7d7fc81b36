// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The macro stage: a printer carriage behind a saturated drive and a dead zone that stands for its friction.
//
//     w = g clamp(u, -limit, limit) + b                        drive: gain g, force on the carriage b (V)
//     V = sgn(w) (a0 + d (|w| - w0))  for |w| >= w0, else 0     dead zone
//     tau dv/dt = K V - v,   dy/dt = v                          carriage
//
// The command is held over a tick, so the motion has an exact solution. At either end of travel the carriage
// stops without rebound. Friction acts at the input only: without effective voltage the carriage coasts to
// rest.
//
// Effects may add a delay of the command (plant/delay_line.h) and a drive voltage by a formula, which keep
// the exact solution; and forces by position, friction on the motion, a belt, play and forces by formulas
// (plant/mechanism.h), which are integrated.
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

/// The parameters of the axis, which effects change.
struct MacroAxisParameters {
    double low_mm = 0.0;           ///< lower end of the travel; may be infinite
    double high_mm = 0.0;          ///< upper end of the travel
    double command_limit_V = 0.0;  ///< largest command in either direction
    double drive_gain = 1.0;       ///< g: gain of the amplifier
    /// b: a force that also acts on a carriage at rest, where the dead zone holds it.
    double drive_bias_V = 0.0;
    DeadZone dead_zone;                ///< Coulomb friction, as a dead zone of the voltage
    double dead_zone_on_motion = 0.0;  ///< fraction of the dead zone that acts as dry friction on the motion
    double velocity_gain_mm_per_s_per_V = 0.0;  ///< K
    double time_constant_s = 0.0;               ///< tau

    double delay_s = 0.0;      ///< delay of the command
    StandingForce standing{};  ///< forces by position
    Friction friction{};       ///< friction on the motion
    Belt belt{};               ///< the belt between drive and carriage
    double play_mm = 0.0;      ///< width of the play (backlash), from one side to the other
    Formulas formulas{};       ///< formulas at the ports of the carriage
};

/// What formulas see of a carriage besides its motion, and their memories.
struct CarriageFormulaState {
    double time_s = 0.0;     ///< time at the tick's beginning
    double way_mm = 0.0;     ///< distance covered until then, in whichever direction
    double command_V = 0.0;  ///< the command in force, after saturation
    FormulaMemory memory{};  ///< the formulas' memories
};

/// Position in the stage frame, velocity positive to the right.
struct MacroAxisState {
    double position_mm = 0.0;         ///< in the stage's frame
    double velocity_mm_per_s = 0.0;   ///< positive to the right
    MechanismState mechanism{};       ///< state of belt, play and bristles
    DelayLineState delay{};           ///< state of the command's delay, from `start`; empty without one
    CarriageFormulaState formulas{};  ///< what formulas see and remember
};

/// The axis's parameters and constants that follow from them for one tick. Immutable.
struct MacroAxis {
    MacroAxisParameters parameters;  ///< as they were given
    double tick_s = 0.0;             ///< T
    double decay = 0.0;              ///< exp(-T / tau)
    double glide_s = 0.0;            ///< tau (1 - decay): distance per unit of velocity in excess of K V

    bool has_closed_form = true;  ///< none of the effects below acts, so that a tick has an exact solution
    bool has_standing_force = false;  ///< a force acts by position
    bool has_friction = false;        ///< there is friction on the motion
    /// A formula adds to the forces by position; has_standing_force is then true, too.
    bool has_force_formula = false;
    bool has_friction_formula = false;  ///< a formula adds to friction; has_friction is then true, too
    bool has_bristles = false;          ///< friction has bristles that bend
    bool turns_matter = false;          ///< a reversal is an event: forces change there, or play begins
    /// A formula's force by position differs by the direction of motion.
    bool force_turns = false;
    /// A formula's force depends on the speed, and may push the motion back so hard that steps are implicit.
    bool is_pushed_back = false;
    bool has_belt = false;        ///< a belt separates drive and carriage
    BeltForce belt{};             ///< constants of the belt's force
    double driven_low_mm = 0.0;   ///< travel of the driving part: wider by the play
    double driven_high_mm = 0.0;  ///< upper end of the driving part's travel
    double longest_step_s = 0.0;  ///< largest step of the numerical integration
    WholeSteps whole_steps{};     ///< matrices of the exact step over a tick without an event
    bool has_series = false;      ///< between events the motion can be computed as a power series
};

/// The axis of a rig, without effects. tau = -T / ln(pole).
MacroAxisParameters macro_axis_parameters(const Rig& rig);

/// Throws InputError where the total damping in one direction is not positive: the carriage would run away.
MacroAxis make_macro_axis(const MacroAxisParameters& parameters, double tick_s);

/// The state of a carriage at rest at a position, in the middle of its play, with commands of 0 so far.
MacroAxisState start(const MacroAxis& axis, double position_mm);

/// What formulas see of a carriage's motion.
struct CarriageSight {
    /// In the stage's frame.
    double place_mm, speed_mm_per_s;
    double direction;        ///< 1 or -1; for a carriage at rest, the direction of the pull
    double voltage_V = 0.0;  ///< what is left of drive and forces behind the dead zone
};

/// The variables for formulas at the carriage, in the order of plant/formulas/port.h.
std::array<double, carriage_variable::count> formula_variables(const CarriageFormulaState& seen,
                                                               const CarriageSight& sight);

/// The sum of the formulas at a port of the carriage, V.
inline double formula_V(const Formulas& formulas, const CarriageFormulaState& seen, Port port,
                        const CarriageSight& sight) {
    return formulas.value(port, formula_variables(seen, sight), seen.memory);
}

/// The same, whatever its value, which may be NaN: for states on trial.
inline double any_formula_V(const Formulas& formulas, const CarriageFormulaState& seen, Port port,
                            const CarriageSight& sight) {
    return formulas.any_value(port, formula_variables(seen, sight), seen.memory);
}

/// The command limited to the drive's range, V.
inline double saturated_V(const MacroAxisParameters& parameters, double command_V) {
    return std::clamp(command_V, -parameters.command_limit_V, parameters.command_limit_V);
}

/// The drive's output in V: the amplified command, without the forces on the carriage.
double drive_voltage_V(const MacroAxisParameters& parameters, double command_V);

/// The voltage V behind the dead zone for a command u, both in V, without forces by position.
double effective_voltage_V(const MacroAxisParameters& parameters, double command_V);

/// Moves the carriage by one tick under a held command in V.
/// @return the number of integration steps; none where there was an exact solution
StepCount advance(const MacroAxis& axis, MacroAxisState& state, double command_V);

}  // namespace fidservo::plant
