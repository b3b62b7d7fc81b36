#include "gap/carriage_forces.h"
#include "gap/hat_functions.h"
#include "gap/period_search.h"
#include "gap/surrogate.h"
#include "plant/dead_zone.h"

#include <array>
#include <cmath>
#include <functional>
#include <numbers>

namespace fidservo::gap {
namespace {

/// By how much commands may be late.
constexpr std::array<std::size_t, 2> late_ticks{2, 8};

using Quantity = std::function<double(const SlidingRow&)>;

/// What commands leave for motion by the file's friction, row by row of every recording, V.
std::vector<std::vector<double>> effective_V(const Evidence& evidence) {
    const DeadZone& zone = evidence.rig().macro.dead_zone;
    std::vector<std::vector<double>> all;
    for (const Recording& recording : evidence.recordings()) {
        std::vector<double>& of_run = all.emplace_back();
        of_run.reserve(recording.rows.size());
        for (const StageRow& row : recording.rows)
            of_run.push_back(plant::dead_zone_V(zone, plant::dead_zone_branch(zone, row.macro_command_V),
                                                row.macro_command_V));
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
void add_hats(
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
void add_waves(std::vector<Column>& columns, const CarriageForces& forces, double period_mm) {
    for (const double phase : {0.0, 0.5 * std::numbers::pi}) {
        const auto wave = [=](double waves_in_period) {
            const double per_mm = 2.0 * std::numbers::pi * waves_in_period / period_mm;
            return [=](const SlidingRow& at) { return std::sin(per_mm * at.position_mm + phase); };
        };
        columns.push_back(force(forces, Dependence::position_period, passed(wave(1.0))));
        columns.push_back(reading(forces, Dependence::reading_period, wave(1.0)));
        columns.push_back(reading(forces, Dependence::reading_period, wave(2.0)));
    }
}

}  // namespace

Surrogate carriage_surrogate(const Evidence& evidence, const Errors& errors, double edge_V) {
    constexpr std::size_t half_support = 25;  // rows: about a time constant of the carriage
    const CarriageForces forces(evidence, errors, half_support, edge_V);
    Surrogate surrogate{Signal::encoder, {}, {}};
    surrogate.errors = forces.lacking();
    surrogate.as_good = 0.95;
    std::vector<Column>& columns = surrogate.columns;
    const Quantity share_passed = [](const SlidingRow& at) { return at.passed; };
    const Quantity position_mm = [](const SlidingRow& at) { return at.position_mm; };
    const Quantity direction = [](const SlidingRow& at) { return at.direction; };
    const Quantity acceleration = [](const SlidingRow& at) { return at.acceleration_mm_per_s2; };
    add_hats(columns, forces, Dependence::velocity, 12,
             [](const SlidingRow& at) { return at.velocity_mm_per_s; });
    columns.push_back(force(forces, Dependence::direction, direction));
    columns.push_back(force(forces, Dependence::nothing, share_passed));
    add_hats(columns, forces, Dependence::position, 16, position_mm, share_passed);
    add_hats(columns, forces, Dependence::position_friction, 16, position_mm, direction);
    columns.push_back(force(forces, Dependence::acceleration, acceleration));
    columns.push_back(reading(forces, Dependence::acceleration, acceleration));
    add_hats(
        columns, forces, Dependence::command, 8, [](const SlidingRow& at) { return at.command_V; },
        share_passed);
    const std::vector<std::vector<double>> effective = effective_V(evidence);
    for (const std::size_t ticks : late_ticks)
        columns.push_back(force(forces, Dependence::command_change, [&, ticks](const SlidingRow& at) {
            const std::vector<double>& of_run = effective[at.run];
            return of_run[at.row >= ticks ? at.row - ticks : 0] - of_run[at.row];
        }));
    add_hats(
        columns, forces, Dependence::time, 6, [](const SlidingRow& at) { return at.time_s; }, share_passed);
    const auto periods = strongest_periods(evidence, errors);
    if (!periods.empty()) surrogate.period_mm = periods.front().period_mm;
    if (surrogate.period_mm > 0.0) add_waves(columns, forces, surrogate.period_mm);
    return surrogate;
}

}  // namespace fidservo::gap
