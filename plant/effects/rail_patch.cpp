#include "plant/effects/creeping_friction.h"

namespace fidservo::plant::effects {

namespace {

constexpr EffectParameter parameters[] = {
    {"level_V", "V", 0.0, 3.0, 0.0, 0.2, "friction at the centre"},
    {"centre_mm", "mm", -1000.0, 1000.0, 100.0, 100.0, "where"},
    {"width_mm", "mm", 0.1, 200.0, 10.0, 10.0, "standard deviation of the bell"},
    creep_speed,
    {"edge", "", 2.0, 16.0, 2.0, 2.0, "exponent of the distance: 2 a bell, more the steeper its edges", 0.1},
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
    .text =
        "Dry friction raised around a place on the rail (dirt, a dent): F = Fp exp(-(|y - yp| / wp)^m / 2) "
        "sgn(v). With a creep speed vc, tanh(v / vc) stands for sgn(v), and nothing is held there.",
    .source = "Armstrong-Helouvry, Control of Machines with Friction, 1991: position-dependent friction",
    .parameters = parameters,
    .apply = apply,
    .needs_place = true,
};

}  // namespace fidservo::plant::effects
