// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/selfcheck/draw/discrepancy_draw.h"

#include "src/selfcheck/draw/listed_effects.h"

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace fidservo::selfcheck {
namespace {

using enum reference::ActsOn;
using enum reference::DependsOn;

constexpr std::array discrepancies{
    DiscrepancyKind{"macro.friction", "speed", carriage_friction, carriage_speed, 3e-3, 0.3},
    DiscrepancyKind{"macro.friction", "place", carriage_friction, carriage_place, 3e-3, 0.3},
    DiscrepancyKind{"macro.mechanics", "place", carriage_force, carriage_place, 3e-3, 0.3},
    DiscrepancyKind{"micro.hall", "contraction", hall_reading, contraction, 3e-3, 0.3},
    DiscrepancyKind{"micro.hall", "temperature", hall_reading, wire_temperature, 3e-3, 0.3},
    DiscrepancyKind{"micro.hall", "time", hall_reading, time, 3e-3, 0.3},
    DiscrepancyKind{"camera.geometry", "place", camera_place, carriage_place, 1e-3, 0.1},
    DiscrepancyKind{"camera.geometry", "time", camera_place, time, 1e-3, 0.1},
};

/// The lowest and the highest value of a variable in a campaign's recordings, in its own unit (mm/s, mm, degC
/// or s).
std::pair<double, double> range_of(reference::DependsOn variable, const Rig& rig) {
    constexpr double longest_recording_s = 35.0, middle_of_travel = 0.25;
    const MacroParameters& macro = rig.macro;
    const HeaterParameters& heater = rig.micro->heater;
    switch (variable) {
        case carriage_speed: {
            const DeadZone& zone = macro.dead_zone;
            const double fastest = macro.velocity_gain_mm_per_s_per_V *
                                   (zone.offset_V + zone.slope * (macro.command_limit_V - zone.threshold_V));
            return {-fastest, fastest};
        }
        case carriage_place: {
            const double edge_mm = middle_of_travel * (macro.high_mm - macro.low_mm);
            return {macro.low_mm + edge_mm, macro.high_mm - edge_mm};
        }
        case contraction:
            return {rig.micro->low_mm, rig.micro->high_mm};
        case wire_temperature:
            return {0.0, heater.gain_degC_per_V * (heater.limit_V - heater.onset_V)};
        case time:
            break;
    }
    return {0.0, longest_recording_s};
}

}  // namespace

std::span<const DiscrepancyKind> discrepancy_kinds() {
    return discrepancies;
}

reference::Discrepancy draw_discrepancy(const DiscrepancyKind& kind, const Rig& rig, double size,
                                        NoiseStream& draw) {
    const double length = log_uniform(draw, 1.0 / 6.0, 0.5);  // of half the range
    std::array<double, reference::smooth_waves> wave_numbers{}, phases_rad{};
    for (double& wave_number : wave_numbers) wave_number = draw.normal() / length;
    for (double& phase : phases_rad) phase = std::numbers::pi * (2.0 * draw.uniform() - 1.0);
    const auto [low, high] = range_of(kind.variable, rig);
    return {kind.acts_on, kind.variable,
            reference::smooth_function(size, low, high, wave_numbers, phases_rad)};
}

}  // namespace fidservo::selfcheck
