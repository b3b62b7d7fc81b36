// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The micro stage: heater -> wire with hysteresis -> flexure platform -> Hall sensor. The platform moves with
// the wire, and swings about it when the carriage accelerates:
//
//     x = stroke factor * Preisach(T - table shift) + z           z: plant/platform_swing.h; formulas add to
//     heating, shift, contraction, platform and voltage (plant/formulas/port.h)
//     V = Hall(x) + drift(t) + leak * u                           t from the start, u: the macro drive's
//     voltage, or that behind a filter of first order
#include "core/preisach.h"
#include "core/time.h"
#include "plant/formulas/formulas.h"
#include "plant/hall_sensor.h"
#include "plant/heater.h"
#include "plant/platform_swing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

namespace fidservo {
struct Rig;
}

namespace fidservo::plant {

/// What comes to the Hall sensor's voltage beside the platform's position.
struct HallDisturbance {
    double drift_V_per_s = 0.0;   ///< of the zero, at first
    double settling_per_s = 0.0;  ///< rate at which that settles; 0: never
    double leak_V_per_V = 0.0;    ///< of the macro drive
    double leak_lag_s = 0.0;      ///< time constant with which it follows the drive

    /// Rate t, or rate (1 - exp(-settling t)) / settling; 1 V at most.
    double drift_V(double time_s) const {
        constexpr double limit_V = 1.0;
        const double grown_s =
            settling_per_s == 0.0 ? time_s : -std::expm1(-settling_per_s * time_s) / settling_per_s;
        return std::clamp(drift_V_per_s * grown_s, -limit_V, limit_V);
    }

    /// Of the way to a held voltage, what is gone in a time.
    double leak_share(double time_s) const {
        return leak_lag_s == 0.0 ? 1.0 : -std::expm1(-time_s / leak_lag_s);
    }

    /// Whether nothing comes to the voltage.
    bool is_none() const { return drift_V_per_s == 0.0 && leak_V_per_V == 0.0; }
};

/// All numbers of the micro stage, open to changes by effects.
struct MicroStageParameters {
    HeaterParameters heater;                ///< of the wire
    SecondMass mass = {};                   ///< what the wire warms besides itself
    double heater_delay_s = 0.0;            ///< from a command to its effect
    std::shared_ptr<const FodTable> fod;    ///< the wire's hysteresis
    double table_shift_degC = 0.0;          ///< of the transformation temperatures against the table
    double table_shift_degC_per_mm = 0.0;   ///< and by this much more with the wire's contraction
    double stroke_factor = 1.0;             ///< contraction per contraction of the table
    SwingParameters swing = {};             ///< of the platform about the wire
    HallParameters hall;                    ///< the platform's sensor
    HallDisturbance hall_disturbance = {};  ///< what comes to its voltage
    Formulas formulas = {};                 ///< at the ports of the micro stage
};

/// Immutable.
struct MicroStage {
    Heater heater;                        ///< ready to tick
    std::shared_ptr<const FodTable> fod;  ///< the wire's hysteresis
    /// As in the parameters.
    double table_shift_degC, table_shift_degC_per_mm;
    double stroke_factor;                ///< contraction per contraction of the table
    std::optional<PlatformSwing> swing;  ///< empty: none
    HallSensor hall;                     ///< ready to tick
    HallDisturbance hall_disturbance;    ///< what comes to its voltage
    double leak_share;  ///< of the way to the drive's voltage that what leaks of it goes in a tick
    TimeNs tick_ns;     ///< time between ticks
    Formulas formulas;  ///< at the ports of the micro stage

    /// Whether a tick depends on what the carriage does.
    bool feels_carriage() const {
        using namespace micro_variable;
        return swing || hall_disturbance.leak_V_per_V != 0.0 || formulas.use(place) || formulas.use(speed) ||
               formulas.use(acceleration) || formulas.use(drive);
    }
};

/// What the carriage does to the platform on it during a tick.
struct CarriageInfluence {
    Shaking shaking = {};                         ///< acceleration that makes the platform swing
    double drive_V = 0.0;                         ///< voltage of the macro drive
    double place_mm = 0.0, speed_mm_per_s = 0.0;  ///< of the carriage, at the tick's end
};

/// What formulas see of the micro stage beside its state, and what they remember.
struct MicroFormulaState {
    double command_V = 0.0;             ///< of the last tick
    double wire_mm = 0.0;               ///< contraction, of the wire alone
    double contraction_mm_per_s = 0.0;  ///< its rate over the last tick
    double beside_mm = 0.0;             ///< what formulas add to the platform's place, contained in it
    CarriageInfluence carriage = {};    ///< of the last tick
    FormulaMemory memory = {};          ///< what formulas remember
};

/// All that a run changes.
struct MicroStageState {
    HeaterState heater;      ///< the wire's temperature
    PreisachMemory wire;     ///< what the wire remembers
    double position_mm;      ///< of the platform, 0 where the wire is fully extended
    NoiseStream hall_noise;  ///< of the Hall sensor
    SwingState swing = {};   ///< contained in position_mm
    TimeNs time_ns = 0;      ///< since the start
    double drive_V = 0.0;    ///< the macro drive's voltage in the last tick, filtered as what leaks of it
    MicroFormulaState formulas = {};  ///< what formulas see and remember
};

/// The micro stage of a rig, without effects; empty if it has none.
std::optional<MicroStageParameters> micro_stage_parameters(const Rig& rig);

/// A stage ready to tick, and what follows from its numbers for one tick.
MicroStage make_micro_stage(const MicroStageParameters& parameters, double tick_s);

/// A wire that was not heated for long: at ambient temperature, or where formulas of its heat leave it then,
/// fully extended.
MicroStageState start(const MicroStage& stage, std::uint64_t seed);

/// The temperature that the wire's table is read at: the wire's, less what its load shifts the transformation
/// by, degC. The load is that of the last tick's contraction.
double table_degC(const MicroStage& stage, const MicroStageState& state);

/// Where the wire holds the platform at what it remembers now, with what formulas add, mm.
double held_mm(const MicroStage& stage, const MicroStageState& state);

/// What formulas of the Hall sensor know.
struct HallSight {
    double time_s = 0.0, platform_mm = 0.0;
    double wire_degC = 0.0, room_degC = 0.0;
    CarriageInfluence carriage = {};
};

/// What formulas add to the Hall sensor's voltage, V.
double formula_hall_V(const Formulas& formulas, const HallSight& seen);

/// The Hall sensor's reading without noise, rounding and the converter's ends, in LSB.
double mean_reading_lsb(const MicroStage& stage, const MicroStageState& state);

/// One reading of the Hall sensor, in LSB. Draws once from its noise.
int sample(const MicroStage& stage, MicroStageState& state);

/// One tick under a held command in V. The cost does not grow with the run (core/preisach.h).
void advance(const MicroStage& stage, MicroStageState& state, double command_V,
             const CarriageInfluence& carriage = {});

}  // namespace fidservo::plant
