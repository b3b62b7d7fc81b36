// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Checks of the 1 kHz loop, whichever program controls: signs that the stage does not behave as the program
// assumes. Each of them ends the run with both commands at zero.
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
    unattended,     ///< the motor runs and no program controls it
    hall,           ///< the readings belong to no position of the platform
    overheated,     ///< by the heater's model and the commands, the wire is too hot
    not_following,  ///< the carriage does not go where the model says that the commands drive it
    beyond_travel,  ///< the carriage is beyond an end of its travel
};

struct WatchdogParams {
    double tick_s;
    /// Missed ticks in one go that raise the alarm; also ticks for which the motor runs without a program.
    int late_ticks = 20;
    // Hall sensor: the readings over the travel, and a tenth of the travel to either side.
    double hall_low_adc, hall_high_adc;
    double hall_limit_s = 0.05;  ///< time outside that range that raises the alarm
    // Wire: the heater's model, started at ambient temperature.
    HeaterParameters heater;
    double wire_limit_degC;
    // Carriage: the model tau dv/dt = K V - v with the dead zone. The distance by which it leads the encoder
    // decays with the time constant following_tau_s.
    MacroParameters macro;
    double following_limit_mm = 30.0;
    double following_tau_s = 0.25;
    double overtravel_mm = 2.0;
};

/// The watchdog's parameters for a rig: limits that have a default above keep it; the wire's limit is 15 degC
/// above the highest temperature of its table.
/// @param rig  must have a micro stage
WatchdogParams watchdog_params(const Rig& rig);

struct WatchdogState {
    int unattended_ticks = 0;
    double hall_out_s = 0.0;
    double wire_degC = 0.0;
    double speed_mm_per_s = 0.0;  ///< of the model's carriage
    double lead_mm = 0.0;         ///< distance by which the model's carriage is ahead of the encoder's
    std::optional<std::int64_t> last_count;
};

WatchdogState watchdog_start(const WatchdogParams& params);

struct WatchdogInput {
    StageSample sample;
    StageCommand command;  ///< the commands in force since the last tick
    int ticks_late = 0;    ///< how late this tick is, in whole periods
    bool attended = true;  ///< whether a program controls
    /// Encoder counts of the travel's ends, once they are known.
    std::optional<CarriageTravel> travel;
};

/// One tick. Does not allocate.
Alarm watchdog_update(const WatchdogParams& params, WatchdogState& state, const WatchdogInput& input);

/// One line for the user, with the numbers.
std::string text_of(Alarm alarm, const WatchdogParams& params, const WatchdogState& state,
                    const WatchdogInput& input);

}  // namespace fidservo::control
