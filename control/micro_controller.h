// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The controller of the micro stage, which moves it without limit cycles (hunting).
//
// The published PI hunts because its integrator drives the wire back and forth across the hysteresis. Here it
// stays the inner loop, but its reference changes:
//   approach  A temperature reference T_r runs towards the goal as fast as the heater allows and lands on it
//             exponentially (landing time constant). The position reference is the hysteresis model along
//             T_r, the feedforward the heater's inverse:
//                 r = scale x(T_r),   c_ff = onset + (T_r - Ta + tau dT_r/dt) / gain
//             The goal lies slightly beyond the target, so that the target is crossed at a known low speed.
//   hold      At the crossing the PI is frozen and the wire is brought back from its turning point by a few
//             degrees. There the hysteresis loop is flat: neither noise nor drift moves the platform.
// A move up contracts (heats), a move down extends (cools); each turning point is one entry of the wire's
// Preisach memory.
#include "control/pi_antiwindup.h"
#include "core/micro_model.h"

#include <cstdint>

namespace fidservo::control {

/// How the reference of a move is shaped: numbers that hold for stages of this kind.
struct MicroShaping {
    double landing_tau_s = 0.010;       ///< time constant of the exponential landing
    double fine_landing_tau_s = 0.020;  ///< the same for moves shorter than fine_move_mm
    double fine_move_mm = 0.005;        ///< moves shorter than this are fine ones
    double overreach_mm = 0.0025;       ///< how far beyond the target the reference's goal lies
    double fine_overreach_mm = 0.001;   ///< the same for fine moves
    double authority = 0.97;      ///< fraction of the fastest heating and cooling that the reference may use
    double hold_back_degC = 6.0;  ///< temperature difference between the turning point and the hold
    /// Time constant of the low-pass on the deviation between sensor and reference.
    double filter_tau_s = 0.008;
    /// Observer gain: fraction of the deviation that corrects the temperature at each tick.
    double observer_gain = 0.2;
    /// Slope of the hysteresis branch below which the temperature correction is weakened.
    double flat_slope_mm_per_degC = 0.01;
    /// Fraction of a move's sum of observer corrections that corrects the ambient temperature.
    double ambient_learning = 0.25;
    double ambient_step_degC = 0.5;  ///< largest correction of the ambient temperature after one move
    double timeout_s = 6.0;          ///< time after which a move has failed
};

/// Parameters of the micro stage's controller.
struct MicroControllerParams {
    MicroModel model;      ///< the model of the stage that the controller uses
    PiGains pi;            ///< gains of the inner loop
    double tick_s;         ///< time between ticks
    MicroShaping shaping;  ///< shape of the moves' reference
};

/// What the controller is doing.
enum class MicroPhase : std::uint8_t {
    off,        ///< the heater is off
    open_loop,  ///< the command is given from outside
    approach,   ///< a move is under way
    hold,       ///< the move has ended, the platform is held
    failed      ///< the target was not reached in time; the command holds the last temperature
};

/// All that the controller remembers from tick to tick.
struct MicroControllerState {
    MicroPhase phase = MicroPhase::off;  ///< what it is doing
    PreisachMemory wire{};               ///< Preisach memory of the model's wire
    HeaterParameters heater{};           ///< the model's heater, with the ambient temperature as learnt
    double command_V = 0.0;              ///< the last command
    double position_mm = 0.0;            ///< position of the last sample, through the Hall curve
    double average_mm = 0.0;             ///< low-pass of position_mm
    // State of the approach.
    double target_mm = 0.0;       ///< where the move is to end
    double reference_mm = 0.0;    ///< where the platform should be now
    double reference_degC = 0.0;  ///< where the wire's temperature should be now
    double goal_degC = 0.0;       ///< where the temperature reference ends
    double deviation_mm = 0.0;    ///< low-pass of position - reference
    PreisachMemory start_wire;    ///< Preisach memory of the model's wire when the approach began
    PiState pi{0.0};              ///< state of the inner PI loop
    double surprise_degC = 0.0;   ///< sum of the observer's temperature corrections in this move
    double elapsed_s = 0.0;       ///< time since the move began
    bool up = true;               ///< whether the move contracts the wire
    bool fine = false;            ///< whether it is a fine move
    // State of the hold.
    double hold_V = 0.0;  ///< command that holds the wire's temperature
};

/// The state of a stage without heat, its wire cold and extended.
MicroControllerState micro_start(const MicroControllerParams& params);

/// Begins a move to `target_mm` (platform position). A move of zero length is carried out, too: it puts the
/// wire on a turning point.
void micro_begin_move(const MicroControllerParams& params, MicroControllerState& state, double target_mm);

/// Switches the heater off.
void micro_switch_off(MicroControllerState& state);
/// Holds a command given from outside, V.
void micro_open_loop(MicroControllerState& state, double command_V);

/// One tick.
/// @param hall_adc  the Hall sensor's reading at this tick
/// @return the command in V from this tick on
double micro_update(const MicroControllerParams& params, MicroControllerState& state, double hall_adc);

}  // namespace fidservo::control
