// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/dead_zone.h"
#include "core/rig.h"
#include "gap/balance/carriage_forces.h"
#include "gap/balance/hat_functions.h"
#include "gap/balance/wave_of_force.h"
#include "gap/numbers.h"
#include "gap/residuals/surrogate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <span>

namespace fidservo::gap {
namespace {

/// Of the squares of what is lacking, from which on a period is one.
constexpr double least_share_of_wave = hardly_any;

/// By how much commands may be late.
constexpr std::array<std::size_t, 2> late_ticks{2, 8};

using Quantity = std::function<double(const SlidingRow&)>;

/// What commands leave for motion by the file's friction, row by row of every recording, V.
std::vector<std::vector<double>> drive_after_dead_zone_V(const Evidence& evidence) {
    const DeadZone& zone = evidence.rig().macro.dead_zone;
    std::vector<std::vector<double>> all;
    for (const Recording& recording : evidence.recordings()) {
        std::vector<double>& of_run = all.emplace_back();
        of_run.reserve(recording.rows.size());
        for (const StageRow& row : recording.rows) of_run.push_back(dead_zone_V(zone, row.macro_command_V));
    }
    return all;
}

Column force(const CarriageForces& forces, Dependence dependence, const Quantity& quantity) {
    return forces.of_force(static_cast<int>(dependence), quantity);
}

Column reading(const CarriageForces& forces, Dependence dependence, const Quantity& quantity) {
    return forces.of_reading(static_cast<int>(dependence), quantity);
}

/// What a force that adds to the command comes to behind the dead zone.
Quantity passed(const Quantity& force_V) {
    return [=](const SlidingRow& at) { return at.passed * force_V(at); };
}

/// Any force that is a function of a quantity, times a factor.
void add_force_hats(
    std::vector<Column>& columns, const CarriageForces& forces, Dependence dependence,
    std::size_t knots_count, const Quantity& quantity,
    const Quantity& factor = [](const SlidingRow&) { return 1.0; }) {
    const std::vector<double> knots = knots_by_share(forces.values(quantity), knots_count);
    if (knots.size() < 2) return;
    for (std::size_t k = 0; k < knots.size(); ++k)
        columns.push_back(force(forces, dependence, [&, k](const SlidingRow& at) {
            return factor(at) * hat(knots, k, quantity(at));
        }));
}

/// A force may be a sine; graduations err in harmonics too.
/// @param is_meant  rows that the wave passes through
void add_waves(std::vector<Column>& columns, const CarriageForces& forces, double period_mm,
               const std::function<bool(const SlidingRow&)>& is_meant) {
    for (const double phase : {0.0, 0.5 * std::numbers::pi}) {
        const auto wave = [&](double waves_in_period) {
            const double per_mm = 2.0 * std::numbers::pi * waves_in_period / period_mm;
            return [=](const SlidingRow& at) {
                return is_meant(at) ? std::sin(per_mm * at.position_mm + phase) : 0.0;
            };
        };
        columns.push_back(force(forces, Dependence::position_period, passed(wave(1.0))));
        columns.push_back(reading(forces, Dependence::reading_period, wave(1.0)));
        columns.push_back(reading(forces, Dependence::reading_period, wave(2.0)));
    }
}

/// Steps of a converter make the force that is lacking a saw's teeth of the command; a pulley that runs out
/// of true gives it a periodic share of what the drive pushes with.
/// @param effective_V  of effective_V()
void add_waves_of_drive(std::vector<Column>& columns, const CarriageForces& forces,
                        const Quantity& share_passed, const Quantity& drive_after_dead_zone_V) {
    constexpr double shortest_V = 0.1, longest_V = 1.0, shortest_mm = 5.0;
    const auto add = [&](Dependence dependence, const Quantity& quantity, const Quantity& factor,
                         double shortest, double longest, std::span<const double> harmonics) {
        const WaveOfForce wave = strongest_wave(forces, quantity, factor, shortest, longest);
        if (wave.share < least_share_of_wave) return;
        for (const double harmonic : harmonics)
            for (const double phase : {0.0, 0.5 * std::numbers::pi})
                columns.push_back(force(forces, dependence, [&](const SlidingRow& at) {
                    return factor(at) *
                           std::sin(2.0 * std::numbers::pi * harmonic * quantity(at) / wave.period + phase);
                }));
    };
    add(
        Dependence::command_period, [](const SlidingRow& at) { return at.command_V; }, share_passed,
        shortest_V, longest_V, std::array{1.0, 2.0});
    add(
        Dependence::position_drive, [](const SlidingRow& at) { return at.position_mm; },
        drive_after_dead_zone_V, shortest_mm, longest_period_mm, std::array{1.0});
}

}  // namespace

bool has_own_zeros(const Evidence& evidence) {
    return std::ranges::any_of(evidence.recordings(),
                               [](const Recording& recording) { return recording.columns.position; });
}

std::vector<std::vector<double>> ways_gone_mm(const Evidence& evidence) {
    std::vector<std::vector<double>> all;
    for (std::size_t run = 0; run < evidence.recordings().size(); ++run) {
        std::vector<double>& of_run = all.emplace_back();
        double way = 0.0;
        for (const float velocity : evidence.course(run).velocity_mm_per_s) {
            if (std::isfinite(velocity))
                way += std::abs(static_cast<double>(velocity)) * evidence.rig().tick_s;
            of_run.push_back(way);
        }
    }
    return all;
}

Surrogate carriage_surrogate(const Evidence& evidence, const Errors& errors, double edge_V,
                             const PositionPeriod& period) {
    // A wave that a long support spans is averaged away.
    const bool is_wave = period.share > least_share_of_wave;
    const std::size_t half_support = is_wave ? period.half_support : long_half_support;
    const double period_mm = period.period_mm;
    const CarriageForces forces(evidence, errors, half_support, edge_V);
    Surrogate surrogate{Signal::encoder, {}, {}};
    surrogate.errors = forces.lacking();
    surrogate.windows = forces.windows();
    surrogate.as_good = nearly_as_good;
    std::vector<Column>& columns = surrogate.columns;
    const Quantity share_passed = [](const SlidingRow& at) { return at.passed; };
    const Quantity position_mm = [](const SlidingRow& at) { return at.position_mm; };
    const Quantity direction = [](const SlidingRow& at) { return at.direction; };
    const Quantity acceleration = [](const SlidingRow& at) { return at.acceleration_mm_per_s2; };
    add_force_hats(columns, forces, Dependence::velocity, force_hats,
                   [](const SlidingRow& at) { return at.velocity_mm_per_s; });
    columns.push_back(
        force(forces, Dependence::velocity_share, [](const SlidingRow& at) { return at.velocity_mm_per_s; }));
    columns.push_back(force(forces, Dependence::direction, direction));
    columns.push_back(force(forces, Dependence::nothing, share_passed));
    add_force_hats(columns, forces, Dependence::position, rail_hats, position_mm, share_passed);
    add_force_hats(columns, forces, Dependence::position_friction, rail_hats, position_mm, direction);
    columns.push_back(force(forces, Dependence::acceleration, acceleration));
    columns.push_back(reading(forces, Dependence::acceleration, acceleration));
    add_force_hats(
        columns, forces, Dependence::command, force_hats, [](const SlidingRow& at) { return at.command_V; },
        share_passed);
    columns.push_back(
        force(forces, Dependence::command_share, passed([](const SlidingRow& at) { return at.command_V; })));
    const std::vector<std::vector<double>> effective = drive_after_dead_zone_V(evidence);
    for (const std::size_t ticks : late_ticks)
        columns.push_back(force(forces, Dependence::command_change, [&, ticks](const SlidingRow& at) {
            const std::vector<double>& of_run = effective[at.run];
            return of_run[at.row >= ticks ? at.row - ticks : 0] - of_run[at.row];
        }));
    const Quantity time_s = [](const SlidingRow& at) { return at.time_s; };
    add_force_hats(columns, forces, Dependence::time, slow_hats, time_s, share_passed);
    const Quantity drive_V = [&](const SlidingRow& at) { return effective[at.run][at.row]; };
    add_force_hats(columns, forces, Dependence::time, slow_hats, time_s, drive_V);
    const std::vector<std::vector<double>> way = ways_gone_mm(evidence);
    add_force_hats(
        columns, forces, Dependence::way_friction, slow_hats,
        [&](const SlidingRow& at) { return way[at.run][at.row]; }, direction);
    add_waves_of_drive(columns, forces, share_passed, drive_V);
    surrogate.period_mm = period_mm;
    if (period_mm <= 0.0) return surrogate;
    if (!has_own_zeros(evidence)) {
        add_waves(columns, forces, period_mm, [](const SlidingRow&) { return true; });
        return surrogate;
    }
    for (std::size_t run = 0; run < evidence.recordings().size(); ++run)
        add_waves(columns, forces, period_mm, [=](const SlidingRow& at) { return at.run == run; });
    return surrogate;
}

}  // namespace fidservo::gap
