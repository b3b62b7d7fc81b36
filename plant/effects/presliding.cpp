#include "plant/effects/effect.h"

namespace fidservo::plant::effects {

namespace {

constexpr EffectParameter parameters[] = {
    {"level_V", "V", 0.0, 3.0, 0.0, 0.1, "friction once it slides"},
    {"distance_um", "um", 0.1, 1000.0, 50.0, 50.0, "way over which the bristles bend"},
    {"damping_V_s_per_mm", "V s/mm", 0.0, 0.05, 0.0, 0.0, "of the bristles"},
};

void apply(PlantParameters& plant, std::span<const double> values) {
    Friction& friction = plant.axis.friction;
    friction.coulomb_V += values[0];
    friction.bristle_mm += 1e-3 * values[1];
    friction.bristle_damping_V_s_per_mm += values[2];
}

}  // namespace

extern constexpr Effect presliding{
    .name = "presliding",
    .block = "macro.friction",
    .text =
        "Elastic micro-motion before break-away: bristles of bend z carry all dry friction g, "
        "F = Fc z + c1 dz/dt d, dz/dt = (v - |v| z Fc / g) / d, where Fc is this level plus other Coulomb "
        "friction. LuGre with sigma0 = Fc / d, sigma1 = c1; Dahl without damping.",
    .source =
        "Dahl, Aerospace Corp. TOR-0158(3107-18)-1, 1968; Canudas de Wit et al., IEEE Trans. Autom. Control "
        "40(3), 1995",
    .parameters = parameters,
    .apply = apply,
};

}  // namespace fidservo::plant::effects
