// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/effects/effect.h"

namespace fidservo::plant::effects {

namespace {

constexpr EffectParameter parameters[] = {
    {"offset_V", "V", -2.0, 2.0, 0.0, 0.1, "force to the right"},
};

void apply(PlantParameters& plant, std::span<const double> values) {
    plant.axis.drive_bias_V += values[0];
}

}  // namespace

extern constexpr Effect drive_offset{
    .name = "drive_offset",
    .block = "macro.drive",
    .part = Part::carriage,
    .text =
        "A constant force b on the carriage, in volts (tilted rail, asymmetric drive): w = u + b, before the "
        "dead zone, which holds it while the carriage stands.",
    .source = "Armstrong-Helouvry, Dupont, Canudas de Wit, Automatica 30(7), 1994: force balance at rest",
    .parameters = parameters,
    .apply = apply,
};

}  // namespace fidservo::plant::effects
