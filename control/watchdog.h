// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the 1 kHz loop itself watches, whoever controls: signs that the stage is not what the program takes it
// for. Each of them ends the run with both commands at zero.
#include "control/positioner.h"
#include "control/stage.h"
#include "core/macro_parameters.h"
#include "core/micro_parameters.h"

#include <cstdint>
#include <optional>
#include <string>

namespace fidservo {
struct Rig;
}

namespace fidservo::control {

enum class Alarm : std::uint8_t {
    none,
    late,           ///< the loop stood still
    unattended,     ///< the motor runs and nobody controls it
    hall,           ///< readings that no place of the platform gives
    overheated,     ///< by its commands, the wire is too hot
    not_following,  ///< the carriage does not go where the commands drive it
    beyond_travel,  ///< the carriage is beyond an end of its travel
};

struct WatchdogParams {
    double tick_s;
    int late_ticks = 20;  ///< of standstill; also of motion that nobody controls
    // Hall sensor: the readings over the travel and a tenth of it to either side.
    double hall_low_adc, hall_high_adc;
    double hall_limit_s = 0.05;  ///< for so long out of them
    // Wire: the heater's model, from ambient.
    HeaterParameters heater;
    double wire_limit_degC;
    // Carriage: tau dv/dt = K V - v with the dead zone; what it leads the encoder by, forgotten with
    // following_tau_s.
    MacroParameters macro;
    double following_limit_mm = 30.0;
    double following_tau_s = 0.25;
    double overtravel_mm = 2.0;
};

/// Those of a rig, with the limits that are not given as above and the wire's 15 degC above its table.
/// @param rig  must have a micro stage
WatchdogParams watchdog_params(const Rig& rig);

struct WatchdogState {
    int unattended_ticks = 0;
    double hall_out_s = 0.0;
    double wire_degC = 0.0;
    double speed_mm_per_s = 0.0;  ///< of the model's carriage
    double lead_mm = 0.0;         ///< of the model's carriage before the encoder's
    std::optional<std::int64_t> last_count;
};

WatchdogState watchdog_start(const WatchdogParams& params);

struct WatchdogInput {
    StageSample sample;
    StageCommand command;  ///< in force since the last tick
    int ticks_late = 0;    ///< of this tick, whole periods
    bool attended = true;  ///< somebody controls
    /// Counts of the travel's ends, once they are known.
    std::optional<CarriageTravel> travel;
};

/// One tick. Does not allocate.
Alarm watchdog_update(const WatchdogParams& params, WatchdogState& state, const WatchdogInput& input);

/// One line for people, with the numbers.
std::string text_of(Alarm alarm, const WatchdogParams& params, const WatchdogState& state,
                    const WatchdogInput& input);

}  // namespace fidservo::control
