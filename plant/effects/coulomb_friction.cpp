// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/macro_parameters.h"
#include "plant/effects/creeping_friction.h"

namespace fidservo::plant::effects {

namespace {

constexpr EffectParameter parameters[] = {
    {"level_V", "V", 0.0, 3.0, 0.0, 0.1, "friction while the carriage moves"},
    {"dead_zone_share", "", 0.0, 1.0, 0.0, 0.5,
     "of the dead zone, that acts on the motion instead: it brakes a coasting carriage"},
    creep_speed,
    parameter::choice(
        "only_coasting", 0.0,
        "1: that share brakes while the drive has no voltage for motion, and stays in the dead zone"),
};

void apply(PlantParameters& plant, std::span<const double> values) {
    const DeadZone& zone = plant.axis.dead_zone;
    Friction& friction = plant.axis.friction;
    const double share_V = values[1] * (zone.slope * zone.threshold_V - zone.offset_V);
    friction.coulomb_V += values[0];
    if (parameters[3].is_high(values[3])) {
        friction.coasting_V += share_V;
    } else {
        friction.coulomb_V += share_V;
        friction.hold_V += values[1] * zone.offset_V;
        plant.axis.dead_zone_on_motion = values[1];
    }
    if (values[0] != 0.0 || values[1] != 0.0) let_creep(friction, values[2]);
}

}  // namespace

extern constexpr Effect coulomb_friction{
    .name = "coulomb_friction",
    .block = "macro.friction",
    .part = Part::carriage,
    .text =
        "Dry friction on the motion: F = Fc sgn(v), tau dv/dt = K (V - F) - v. It brakes a coasting carriage "
        "to a "
        "stop, and holds one at rest while |V| is not above Fc. A share of the dead zone may act so too, "
        "instead of at the input, or only where V = 0. With a creep speed vc, tanh(v / vc) stands for "
        "sgn(v), and nothing is held.",
    .source =
        "Armstrong-Helouvry, Dupont, Canudas de Wit, Automatica 30(7), 1994; Andersson et al., "
        "Tribology Int. 40, 2007: tanh",
    .parameters = parameters,
    .apply = apply,
};

}  // namespace fidservo::plant::effects
