// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/effects/effect.h"

namespace fidservo::plant::effects {

extern const Effect viscous_friction;

namespace {

constexpr EffectParameter parameters[] = {
    {"right_V_s_per_mm", "V s/mm", -0.004, 0.05, 0.0, 0.0005,
     "damping of motion to the right beyond nominal"},
    {"left_V_s_per_mm", "V s/mm", -0.004, 0.05, 0.0, -0.0005, "damping of motion to the left beyond nominal"},
};

void apply(PlantParameters& plant, std::span<const double> values) {
    plant.axis.friction.right_V_s_per_mm += values[0];
    plant.axis.friction.left_V_s_per_mm += values[1];
}

double mean_of_directions(std::span<const double> values, double /*middle_mm*/) {
    return 0.5 * (values[0] + values[1]);
}

}  // namespace

extern constexpr Effect friction_asymmetry{
    .name = "friction_asymmetry",
    .block = "macro.friction",
    .part = Part::carriage,
    .text = "Viscous friction differs by direction: F = c v with c = c_right for v > 0, c_left for v < 0.",
    .source =
        "Armstrong-Helouvry, Dupont, Canudas de Wit, Automatica 30(7), 1994: friction that depends on "
        "direction",
    .parameters = parameters,
    .apply = apply,
    .plainer = {&viscous_friction, mean_of_directions},
};

}  // namespace fidservo::plant::effects
