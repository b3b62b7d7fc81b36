// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/effects/effect.h"

#include <algorithm>

namespace fidservo::plant::effects {

extern const Effect coulomb_friction;

namespace {

constexpr double distances_um[] = {10.0, 50.0, 250.0};

constexpr EffectParameter parameters[] = {
    {"level_V", "V", 0.0, 3.0, 0.0, 0.1, "friction once it slides"},
    parameter::shape({"distance_um", "um", 0.1, 1000.0, 50.0, 50.0, "way over which the bristles bend"},
                     distances_um),
    parameter::shape({"damping_V_s_per_mm", "V s/mm", 0.0, 0.05, 0.0, 0.0,
                      "of the bristles, at most 50 ms of their stiffness"}),
    parameter::choice("springs", 0.0,
                      "1: bristles are springs until they slide; 0: they give way from the first on"),
};

/// Their relaxation time is bounded, or a level that vanishes would leave the damping.
void apply(PlantParameters& plant, std::span<const double> values) {
    constexpr double longest_relaxation_s = 0.05;
    const double level_V = values[0], distance_mm = 1e-3 * values[1];
    Friction& friction = plant.axis.friction;
    friction.coulomb_V += level_V;
    friction.bristle_mm = distance_mm;
    friction.bristle_damping_V_s_per_mm = std::min(values[2], longest_relaxation_s * level_V / distance_mm);
    friction.bristles_are_springs = parameters[3].is_high(values[3]);
}

}  // namespace

extern constexpr Effect presliding{
    .name = "presliding",
    .block = "macro.friction",
    .part = Part::carriage,
    .text =
        "Elastic micro-motion before break-away: bristles of bend z carry all dry friction g, "
        "F = Fc z + c1 dz/dt d, dz/dt = (v - |v| z Fc / g) / d, where Fc is this level plus other Coulomb "
        "friction and c1 at most 50 ms times level / d. LuGre with sigma0 = Fc / d, sigma1 = c1; Dahl "
        "without damping. As springs, dz/dt = v / d up to where |z| Fc = g.",
    .source =
        "Dahl, Aerospace Corp. TOR-0158(3107-18)-1, 1968; Canudas de Wit et al., IEEE Trans. Autom. Control "
        "40(3), 1995; Dupont et al., ibid. 47(5), 2002: without drift",
    .parameters = parameters,
    .apply = apply,
    .plainer = {&coulomb_friction},  // of stiff bristles
};

}  // namespace fidservo::plant::effects
