#include "gap/force_balance.h"

#include "core/dead_zone.h"
#include "plant/effects/catalogue.h"
#include "plant/stage_plant.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fidservo::gap {
namespace {

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

/// As errors of the windows wanted: all that the supports need of them is where they are.
Errors where_wanted(const Evidence& evidence, const Wanted& wanted) {
    const std::vector<Window>& windows = evidence.windows();
    Errors errors(windows.empty() ? 0 : windows.back().end, not_a_number);
    for (std::size_t w = 0; w < windows.size(); ++w)
        if (wanted[w] != 0 && windows[w].signal == Signal::encoder)
            std::fill(errors.begin() + static_cast<std::ptrdiff_t>(windows[w].begin),
                      errors.begin() + static_cast<std::ptrdiff_t>(windows[w].end), 0.0F);
    return errors;
}

/// In V, at a row.
/// @param stretch  length of a count over the nominal one
double excess_V(const plant::MacroAxisParameters& axis, double stretch, double command_V,
                const SlidingRow& row) {
    const double position_mm = stretch * row.position_mm, velocity = stretch * row.velocity_mm_per_s;
    const double drive_V = plant::drive_voltage_V(axis, command_V) + axis.drive_bias_V +
                           plant::StandingForceNearby(axis.standing).volts(position_mm);
    const double dry_V = plant::dry_friction_V(axis.friction, std::abs(velocity), position_mm);
    const double needed_V = (axis.time_constant_s * stretch * row.acceleration_mm_per_s2 + velocity) /
                            axis.velocity_gain_mm_per_s_per_V;
    return dead_zone_V(axis.dead_zone, drive_V, axis.dead_zone_on_motion) -
           plant::sliding_friction_V(axis.friction, velocity, row.direction, dry_V) - needed_V;
}

}  // namespace

ForceBalance::ForceBalance(const Evidence& evidence, const Wanted& wanted)
    : evidence_(evidence), forces_(evidence, where_wanted(evidence, wanted), short_half_support) {}

Errors ForceBalance::excess(const Hypothesis& hypothesis) const {
    plant::PlantParameters parameters = plant::plant_parameters(evidence_.rig());
    plant::apply_effects(parameters, hypothesis);
    const double stretch = parameters.encoder.resolution_mm / evidence_.rig().macro.encoder_resolution_mm;
    const auto late = static_cast<std::size_t>(std::lround(parameters.axis.delay_s / parameters.tick_s));
    // At a row the readings are of the instant between two commands.
    const Column column = forces_.of_force(0, [&](const SlidingRow& row) {
        const std::vector<StageRow>& rows = evidence_.recordings()[row.run].rows;
        const auto with_command = [&](std::size_t ago) {
            return excess_V(parameters.axis, stretch, rows[row.row - std::min(ago, row.row)].macro_command_V,
                            row);
        };
        return 0.5 * (with_command(late) + with_command(late + 1));
    });
    Errors excess(column.values.size(), not_a_number);
    for (const CarriageForces::Support& support : supports())
        excess[support.slot] = column.values[support.slot];
    return excess;
}

bool shows_in_balance(const plant::Effect& effect) {
    if (!effect.block.starts_with("macro.")) return false;
    plant::PlantParameters parameters;
    effect.apply(parameters, plant::typical_setting(effect).values);
    return parameters.axis.play_mm == 0.0 && parameters.axis.belt.compliance_mm_per_V == 0.0;
}

}  // namespace fidservo::gap
