#include "plant/effects/effect.h"

namespace fidservo::plant::effects {

namespace {

constexpr EffectParameter parameters[] = {
    {"level_V", "V", 0.0, 3.0, 0.0, 0.1, "friction while the carriage moves"},
};

void apply(PlantParameters& plant, std::span<const double> values) {
    plant.axis.friction.coulomb_V += values[0];
}

}  // namespace

extern constexpr Effect coulomb_friction{
    .name = "coulomb_friction",
    .block = "macro.friction",
    .text =
        "Dry friction on the motion: F = Fc sgn(v), tau dv/dt = K (V - F) - v. It brakes a coasting carriage "
        "to a "
        "stop, and holds one at rest while |V| is not above Fc.",
    .source = "Armstrong-Helouvry, Dupont, Canudas de Wit, Automatica 30(7), 1994",
    .parameters = parameters,
    .apply = apply,
};

}  // namespace fidservo::plant::effects
