// SPDX-License-Identifier: GPL-3.0-or-later
#include "reference/dry_friction.h"

#include "core/macro_parameters.h"

#include <algorithm>
#include <cmath>

namespace fidservo::reference {

namespace {

/// In how many parts a step is cut at most before the bristles count as being in equilibrium.
constexpr double most_parts = 32.0;

double level_V(const CarriageModel& model, double position_mm) {
    const FrictionDepartures& friction = model.friction;
    const DeadZone& zone = model.dead_zone;
    double level = friction.coulomb_V;
    level += friction.dead_zone_on_motion * (zone.slope * zone.threshold_V - zone.offset_V);
    if (friction.patch_V != 0.0) {
        const double r = (position_mm - friction.patch_centre_mm) / friction.patch_width_mm;
        level +=
            friction.patch_V * (friction.patch_is_rational ? 1.0 / (1.0 + r * r) : std::exp(-0.5 * r * r));
    }
    return level;
}

double steady_V(const CarriageModel& model, double position_mm, double speed_mm_per_s) {
    const FrictionDepartures& friction = model.friction;
    if (friction.stribeck_V == 0.0) return level_V(model, position_mm);
    const double share = std::abs(speed_mm_per_s) / friction.stribeck_speed_mm_per_s;
    const double decay = friction.stribeck_is_rational
                             ? 1.0 / (1.0 + share * share)
                             : std::exp(-std::pow(share, friction.stribeck_exponent));
    return level_V(model, position_mm) + friction.stribeck_V * decay;
}

Bristles bristles_of(const FrictionDepartures& friction) {
    return friction.bristles.value_or(Bristles{});
}

}  // namespace

bool has_bristles(const FrictionDepartures& friction) {
    return friction.bristles.has_value();
}

bool is_rigid(const FrictionDepartures& friction) {
    return !has_bristles(friction) && friction.creep_mm_per_s == 0.0;
}

ContactStep contact_step(const CarriageModel& model, double position_mm, double speed_mm_per_s, double h_s) {
    if (is_rigid(model.friction)) return {Contact::rigid, h_s};
    if (!has_bristles(model.friction)) return {Contact::lubricated, h_s};
    const double stiffness_V_per_mm = bristles_of(model.friction).stiffness_V_per_mm;
    const double relaxations =
        h_s * stiffness_V_per_mm * std::abs(speed_mm_per_s) / steady_V(model, position_mm, speed_mm_per_s);
    if (relaxations > most_parts) return {Contact::bristles_in_equilibrium, h_s};
    return {Contact::bristles, h_s / std::max(1.0, std::ceil(relaxations))};
}

DryFriction dry_friction(const CarriageModel& model, double position_mm, double speed_mm_per_s,
                         double bristle_mm, double direction, Contact contact) {
    if (contact == Contact::rigid) return {direction * steady_V(model, position_mm, speed_mm_per_s), 0.0};
    const double steady = steady_V(model, position_mm, speed_mm_per_s);
    if (contact == Contact::lubricated)
        return {steady * std::tanh(speed_mm_per_s / model.friction.creep_mm_per_s), 0.0};
    if (contact == Contact::bristles_in_equilibrium) return {std::copysign(steady, speed_mm_per_s), 0.0};
    const Bristles bristles = bristles_of(model.friction);
    const double elastic_V = bristles.stiffness_V_per_mm * bristle_mm;
    const double unbent = 1.0 - std::copysign(elastic_V, elastic_V * speed_mm_per_s) / steady;
    const double bristle_rate =
        speed_mm_per_s * std::copysign(std::pow(std::abs(unbent), bristles.exponent), unbent);
    return {elastic_V + bristles.damping_V_s_per_mm * bristle_rate, bristle_rate};
}

double breakaway_V(const CarriageModel& model, double position_mm) {
    if (!is_rigid(model.friction)) return 0.0;
    return steady_V(model, position_mm, 0.0) + model.friction.dead_zone_on_motion * model.dead_zone.offset_V;
}

double bristle_force_V(const CarriageModel& model, double bristle_mm) {
    return has_bristles(model.friction) ? bristles_of(model.friction).stiffness_V_per_mm * bristle_mm : 0.0;
}

double equilibrium_bristle_mm(const CarriageModel& model, double position_mm, double speed_mm_per_s) {
    return steady_V(model, position_mm, speed_mm_per_s) / bristles_of(model.friction).stiffness_V_per_mm;
}

}  // namespace fidservo::reference
