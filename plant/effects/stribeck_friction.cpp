// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/effects/creeping_friction.h"

namespace fidservo::plant::effects {

extern const Effect coulomb_friction;

namespace {

constexpr double speeds_mm_per_s[] = {4.8, 24.0};

constexpr EffectParameter parameters[] = {
    {"level_V", "V", 0.0, 3.0, 0.0, 0.2, "friction at the lowest speeds beyond that at high speed"},
    parameter::shape({"speed_mm_per_s", "mm/s", 0.5, 300.0, 12.0, 12.0, "at which it has fallen to 1/e"},
                     speeds_mm_per_s),
    creep_speed,
    parameter::optional(
        {"exponent", "", 1.0, 3.0, 1.0, 1.0, "of the speed: 1 falls as an exponential, 2 as a bell"}, 0.02),
};

void apply(PlantParameters& plant, std::span<const double> values) {
    Friction& friction = plant.axis.friction;
    friction.stribeck_V += values[0];
    friction.stribeck_mm_per_s = values[1];
    friction.stribeck_exponent = parameters[3].acting(values[3]);
    if (values[0] != 0.0) let_creep(friction, values[2]);
}

}  // namespace

extern constexpr Effect stribeck_friction{
    .name = "stribeck_friction",
    .block = "macro.friction",
    .part = Part::carriage,
    .text =
        "Friction rises towards low speed: F = Fs exp(-(|v| / vs)^n) sgn(v), which holds a carriage at rest "
        "while |V| "
        "is not above Fs. With a creep speed vc, tanh(v / vc) stands for sgn(v), and nothing is held.",
    .source =
        "Tustin, J. IEE 94(2A), 1947: exponent 1; Armstrong-Helouvry, Dupont, Canudas de Wit, Automatica "
        "30(7), 1994: other exponents; Andersson et al., Tribology Int. 40, 2007: tanh",
    .parameters = parameters,
    .apply = apply,
    .plainer = {&coulomb_friction},  // of one that does not fall with speed
};

}  // namespace fidservo::plant::effects
