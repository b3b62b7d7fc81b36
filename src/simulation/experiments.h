// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The experiments for comparing a rig with its simulation: their commands over time.
#include "core/recording.h"

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace fidservo {

struct Rig;

/// A function of time, t in s from the start. It is not in force where it returns NaN; an empty one never is.
using Course = std::function<double(double t_s)>;

/// The function's value; NaN where it is not in force.
inline double value_at(const Course& course, double t_s) {
    return course ? course(t_s) : not_in_force;
}

/// The controller that follows a macro setpoint.
enum class MacroLoop {
    nonlinear_pd,   ///< the published controller: MacroParameters::pd
    benchmark_pid,  ///< the one that it is compared with: MacroParameters::pid
};

/// The commands of one recording. A stage follows its setpoint with its controller wherever one is in force,
/// otherwise its voltage; where neither is in force, the command is zero. A controller starts anew each time
/// a setpoint comes into force.
struct Experiment {
    std::string kind;          ///< one of experiment_kinds(), or a name of its own
    double duration_s = 0.0;   ///< how long it takes
    double carriage_mm = 0.0;  ///< at the start, at rest; the rig is homed and the wire cold
    /// For the carriage: its setpoint, or the motor's voltage.
    Course macro_setpoint_mm = {}, macro_V = {};
    MacroLoop macro_loop = MacroLoop::nonlinear_pd;  ///< the controller that follows the setpoint
    /// For the platform: its setpoint, or the heater's voltage.
    Course micro_setpoint_mm = {}, micro_V = {};
};

/// Piecewise constant: values[i] from times_s[i] on; times ascend from 0.
Course steps(std::vector<double> times_s, std::vector<double> values);

/// rest, macro-pulses, macro-sweep, macro-square, micro-steps, micro-triangle, micro-servo, integrated.
const std::vector<std::string_view>& experiment_kinds();

/// An experiment with its excitation drawn at random: amplitudes, periods and places, scaled to the rig's
/// travel, dead zone and heater.
/// @param name  of the recording; together with the seed it determines the draw
/// Throws InputError on an unknown kind and where the rig lacks the part or the controller that it needs.
Experiment make_experiment(std::string_view kind, const Rig& rig, std::uint64_t seed, std::string_view name);

/// Why a rig cannot do an experiment; empty if it can.
std::string missing_for(std::string_view kind, const Rig& rig);

/// A recording of a campaign. Its name says which experiment it is and no more.
struct CampaignRun {
    std::string kind;  ///< one of experiment_kinds()
    std::string name;  ///< of the recording
};

/// Two of each experiment that the rig can do.
std::vector<CampaignRun> campaign_runs(const Rig& rig);

}  // namespace fidservo
