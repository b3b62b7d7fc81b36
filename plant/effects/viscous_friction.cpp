// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/effects/effect.h"

namespace fidservo::plant::effects {

namespace {

constexpr EffectParameter parameters[] = {
    {"damping_V_s_per_mm", "V s/mm", 0.0, 0.05, 0.0, 0.0005, "force per velocity"},
};

void apply(PlantParameters& plant, std::span<const double> values) {
    const double damping = 1.0 + plant.axis.velocity_gain_mm_per_s_per_V * values[0];
    plant.axis.velocity_gain_mm_per_s_per_V /= damping;
    plant.axis.time_constant_s /= damping;
}

}  // namespace

extern constexpr Effect viscous_friction{
    .name = "viscous_friction",
    .block = "macro.friction",
    .part = Part::carriage,
    .text =
        "Damping beyond the nominal: tau dv/dt = K (V - c v) - v, which is an axis with both K and tau "
        "divided by 1 + K c.",
    .source = "Olsson et al., Friction models and friction compensation, Eur. J. Control 4, 1998",
    .parameters = parameters,
    .apply = apply,
};

}  // namespace fidservo::plant::effects
