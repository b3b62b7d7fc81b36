// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/effects/creeping_friction.h"

namespace fidservo::plant::effects {

extern const Effect coulomb_friction;

namespace {

constexpr double widths_mm[] = {4.0, 20.0};

constexpr EffectParameter parameters[] = {
    {"level_V", "V", 0.0, 3.0, 0.0, 0.2, "friction at the centre"},
    parameter::with_role({"centre_mm", "mm", -1000.0, 1000.0, 100.0, 100.0, "where"}, Role::place),
    parameter::with_role({"width_mm", "mm", 0.1, 200.0, 10.0, 10.0, "standard deviation of the bell"},
                         Role::width, widths_mm),
    creep_speed,
    parameter::optional(
        {"edge", "", 2.0, 16.0, 2.0, 2.0, "exponent of the distance: 2 a bell, more the steeper its edges"},
        0.1),
};

void apply(PlantParameters& plant, std::span<const double> values) {
    RailPatch& patch = plant.axis.friction.patch;
    patch.level_V += values[0];
    patch.centre_mm = values[1];
    patch.width_mm = values[2];
    patch.exponent = parameters[4].acting(values[4]);
    if (values[0] != 0.0) let_creep(plant.axis.friction, values[3]);
}

}  // namespace

extern constexpr Effect rail_patch{
    .name = "rail_patch",
    .block = "macro.friction",
    .part = Part::carriage,
    .text =
        "Dry friction raised around a place on the rail (dirt, a dent): F = Fp exp(-(|y - yp| / wp)^m / 2) "
        "sgn(v). With a creep speed vc, tanh(v / vc) stands for sgn(v), and nothing is held there.",
    .source = "Armstrong-Helouvry, Control of Machines with Friction, 1991: position-dependent friction",
    .parameters = parameters,
    .apply = apply,
    .needs_place = true,
    .plainer = {&coulomb_friction},  // of a patch as long as the rail
};

}  // namespace fidservo::plant::effects
