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

/// What adds to the Hall sensor's voltage besides the platform's position.
struct HallDisturbance {
    double drift_V_per_s = 0.0;   ///< initial drift rate of the zero
    double settling_per_s = 0.0;  ///< rate at which the drift settles; 0: it never does
    double leak_V_per_V = 0.0;    ///< crosstalk from the macro drive's voltage
    double leak_lag_s = 0.0;      ///< time constant of the crosstalk's low-pass

    /// The drift at a time: rate t, or rate (1 - exp(-settling t)) / settling, in either case limited to 1 V.
    double drift_V(double time_s) const {
        constexpr double limit_V = 1.0;
        const double grown_s =
            settling_per_s == 0.0 ? time_s : -std::expm1(-settling_per_s * time_s) / settling_per_s;
        return std::clamp(drift_V_per_s * grown_s, -limit_V, limit_V);
    }

    /// The fraction of a step of the drive's voltage that has passed the crosstalk's low-pass after a time.
    double leak_share(double time_s) const {
        return leak_lag_s == 0.0 ? 1.0 : -std::expm1(-time_s / leak_lag_s);
    }

    /// Whether nothing adds to the voltage.
    bool is_none() const { return drift_V_per_s == 0.0 && leak_V_per_V == 0.0; }
};

/// The parameters of the micro stage, which effects change.
struct MicroStageParameters {
    HeaterParameters heater;              ///< of the wire
    SecondMass mass = {};                 ///< thermal mass that the wire heats
    double heater_delay_s = 0.0;          ///< time from a command to its effect
    std::shared_ptr<const FodTable> fod;  ///< the wire's hysteresis
    double table_shift_degC = 0.0;        ///< rise of the transformation temperatures over those of the table
    double table_shift_degC_per_mm = 0.0;  ///< further rise per mm of the wire's contraction
    double stroke_factor = 1.0;            ///< factor on the table's contraction
    SwingParameters swing = {};  ///< oscillation of the platform about the place where the wire holds it
    HallParameters hall;         ///< the platform's sensor
    HallDisturbance hall_disturbance = {};  ///< what adds to the Hall sensor's voltage
    Formulas formulas = {};                 ///< formulas at the ports of the micro stage
};

/// The micro stage ready to tick. Immutable.
struct MicroStage {
    Heater heater;                        ///< ready to tick
    std::shared_ptr<const FodTable> fod;  ///< the wire's hysteresis
    /// As in MicroStageParameters.
    double table_shift_degC, table_shift_degC_per_mm;
    double stroke_factor;                ///< factor on the table's contraction
    std::optional<PlatformSwing> swing;  ///< empty: the platform does not oscillate
    HallSensor hall;                     ///< ready to tick
    HallDisturbance hall_disturbance;    ///< what adds to the Hall sensor's voltage
    /// Fraction of a step of the drive's voltage that passes the crosstalk's low-pass in a tick.
    double leak_share;
    TimeNs tick_ns;     ///< time between ticks
    Formulas formulas;  ///< formulas at the ports of the micro stage

    /// Whether the micro stage depends on the carriage's motion or drive.
    bool feels_carriage() const {
        using namespace micro_variable;
        return swing || hall_disturbance.leak_V_per_V != 0.0 || formulas.use(place) || formulas.use(speed) ||
               formulas.use(acceleration) || formulas.use(drive);
    }
};

/// What the carriage does to the platform on it during a tick.
struct CarriageInfluence {
    Shaking shaking = {};                         ///< acceleration that excites the platform's oscillation
    double drive_V = 0.0;                         ///< voltage of the macro drive
    double place_mm = 0.0, speed_mm_per_s = 0.0;  ///< of the carriage, at the end of the tick
};

/// What formulas see of the micro stage besides its state, and their memories.
struct MicroFormulaState {
    double command_V = 0.0;             ///< command of the last tick
    double wire_mm = 0.0;               ///< contraction of the wire alone
    double contraction_mm_per_s = 0.0;  ///< rate of the contraction over the last tick
    double beside_mm = 0.0;  ///< what formulas add to the platform's position; position_mm contains it
    CarriageInfluence carriage = {};  ///< the carriage's influence in the last tick
    FormulaMemory memory = {};        ///< the formulas' memories
};

/// All that changes in a run.
struct MicroStageState {
    HeaterState heater;      ///< the wire's temperature
    PreisachMemory wire;     ///< the wire's Preisach memory
    double position_mm;      ///< position of the platform, 0 where the wire is fully extended
    NoiseStream hall_noise;  ///< noise stream of the Hall sensor
    SwingState swing = {};   ///< the platform's oscillation; position_mm contains it
    TimeNs time_ns = 0;      ///< since the start
    double drive_V = 0.0;    ///< the macro drive's voltage in the last tick, behind the crosstalk's low-pass
    MicroFormulaState formulas = {};  ///< what formulas see and remember
};

/// The micro stage of a rig, without effects; empty if it has none.
std::optional<MicroStageParameters> micro_stage_parameters(const Rig& rig);

/// A stage ready to tick, and what follows from its numbers for one tick.
MicroStage make_micro_stage(const MicroStageParameters& parameters, double tick_s);

/// The state of a stage whose wire has not been heated for a long time: fully extended, at ambient
/// temperature or where formulas of its heat bring it.
MicroStageState start(const MicroStage& stage, std::uint64_t seed);

/// The temperature at which the wire's table is read, degC: the wire's temperature less the shift of the
/// transformation by the load. The load follows the contraction of the last tick.
double table_degC(const MicroStage& stage, const MicroStageState& state);

/// The place where the wire, with its present memory, holds the platform, formulas included, mm.
double held_mm(const MicroStage& stage, const MicroStageState& state);

/// What formulas see at the Hall sensor.
struct HallSight {
    double time_s = 0.0;              ///< since the recording's first row
    double platform_mm = 0.0;         ///< the platform's place, which the sensor sees
    double wire_degC = 0.0;           ///< the wire's temperature
    double room_degC = 0.0;           ///< the room's temperature
    CarriageInfluence carriage = {};  ///< the carriage's motion below the platform
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
