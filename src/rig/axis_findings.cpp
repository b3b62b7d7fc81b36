// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/dead_zone.h"
#include "core/rig.h"
#include "src/rig/finding.h"

#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace fidservo {

namespace {

/// What the guardian process bears of silence from the loop (docs/adr/0006-guardian-process.md).
constexpr double longest_tick_s = 0.020;
/// Belt-driven linear axes reach 5 m/s by their catalogues.
constexpr double top_speed_mm_per_s = 5000.0;
/// Mechanical time constants of motors are 1 to 100 ms by their catalogues; a heavy carriage makes that some
/// seconds. Hours, or less than a tick, come from a pole per another tick.
constexpr double longest_axis_tau_s = 10.0;
/// e^-5 per tick: the dynamics are over before the next sample, and nothing measures them.
constexpr double least_pole = 0.0067;
/// The supervisor gives a motion up after 8 s (control/positioner.h); with a tenth of the full command, which
/// is what a controller has left near its goal, it takes ten times as long as with all of it.
constexpr double longest_crossing_s = 8.0 / 0.1;
/// Laser interferometers resolve a nanometre or so; what is finer is in another unit.
constexpr double finest_mm = 1e-7;

/// From rest over the travel at the full command: x(t) = top (t - tau (1 - exp(-t / tau))), by bisection.
double crossing_s(double travel_mm, double top_mm_per_s, double tau_s) {
    double low_s = 0.0, high_s = 2.0 * (travel_mm / top_mm_per_s + tau_s + 1e-9);
    for (int i = 0; i < 60; ++i) {
        const double t_s = 0.5 * (low_s + high_s);
        const double x_mm = top_mm_per_s * (t_s + tau_s * std::expm1(-t_s / tau_s));
        (x_mm < travel_mm ? low_s : high_s) = t_s;
    }
    return high_s;
}

void look_at_encoder(const MacroParameters& macro, std::vector<Finding>& findings) {
    const double count_mm = macro.encoder_resolution_mm, travel_mm = macro.high_mm - macro.low_mm;
    if (count_mm <= coarsest_step_share * travel_mm && count_mm >= finest_mm) return;
    findings.push_back(
        {"macro.encoder_resolution_mm", fmt::format("{:g}", count_mm),
         fmt::format("a count is {:.3g} of the travel of {:g} mm", count_mm / travel_mm, travel_mm),
         fmt::format("at most 1 % of the travel, {:g} mm; at least {:g} mm", coarsest_step_share * travel_mm,
                     finest_mm)});
}

void look_at_dynamics(const Rig& rig, std::vector<Finding>& findings) {
    const MacroParameters& macro = rig.macro;
    const double tau_s = -rig.tick_s / std::log(macro.velocity_pole);
    if (tau_s > longest_axis_tau_s || macro.velocity_pole < least_pole)
        findings.push_back(
            {"macro.velocity_pole", fmt::format("{:.9g}", macro.velocity_pole),
             fmt::format("per tick of {:g} s it is a time constant of {:.3g} s", rig.tick_s, tau_s),
             fmt::format("a tick to {:g} s: exp(-tick / time constant), {:.6g} for 50 ms", longest_axis_tau_s,
                         std::exp(-rig.tick_s / 0.05))});
    const double travel_mm = macro.high_mm - macro.low_mm;
    const double top_mm_per_s =
        macro.velocity_gain_mm_per_s_per_V * dead_zone_V(macro.dead_zone, macro.command_limit_V);
    const double count_per_s = top_mm_per_s / macro.encoder_resolution_mm;
    const double full_s = crossing_s(travel_mm, top_mm_per_s, tau_s);
    const auto complain_of_gain = [&](std::string why, std::string usual) {
        findings.push_back({"macro.velocity_gain_mm_per_s_per_V",
                            fmt::format("{:g}", macro.velocity_gain_mm_per_s_per_V),
                            "at the command's limit " + std::move(why), std::move(usual)});
    };
    if (top_mm_per_s > top_speed_mm_per_s)
        complain_of_gain(fmt::format("the carriage would run {:.3g} m/s", 1e-3 * top_mm_per_s),
                         fmt::format("at most {:g} m/s, a gain of {:.3g}", 1e-3 * top_speed_mm_per_s,
                                     macro.velocity_gain_mm_per_s_per_V * top_speed_mm_per_s / top_mm_per_s));
    else if (count_per_s < 1.0)
        complain_of_gain(fmt::format("the encoder would see {:.3g} counts a second", count_per_s),
                         "more than a count a second");
    else if (full_s > longest_crossing_s && tau_s <= longest_axis_tau_s)
        complain_of_gain(
            fmt::format("the travel of {:g} mm takes {:.3g} s", travel_mm, full_s),
            fmt::format("at most {:g} s; is the travel, or the gain, in mm?", longest_crossing_s));
}

}  // namespace

std::vector<Finding> axis_findings(const Rig& rig) {
    std::vector<Finding> findings;
    if (rig.tick_s > longest_tick_s)
        findings.push_back(
            {"tick_s", fmt::format("{:g}", rig.tick_s),
             "on a real stage the outputs are switched off when a tick is longer than the guardian waits",
             fmt::format("0.001, at most {:g} s", longest_tick_s)});
    look_at_encoder(rig.macro, findings);
    look_at_dynamics(rig, findings);
    return findings;
}

}  // namespace fidservo
