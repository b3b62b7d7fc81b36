#include "plant/effects/effect.h"

namespace fidservo::plant::effects {

namespace {

constexpr EffectParameter parameters[] = {
    {"stiffness_V_per_mm", "V/mm", 0.0, 0.05, 0.0, 0.002, "of the spring"},
    {"centre_mm", "mm", -1000.0, 1000.0, 100.0, 100.0, "where the harness does not pull"},
};

void apply(PlantParameters& plant, std::span<const double> values) {
    plant.axis.standing.cable_V_per_mm += values[0];
    plant.axis.standing.cable_centre_mm = values[1];
}

}  // namespace

extern constexpr Effect cable_force{
    .name = "cable_force",
    .block = "macro.mechanics",
    .text =
        "The cable harness pulls like a spring: w = u - k (y - y0), before the dead zone, which holds it "
        "while the "
        "carriage stands.",
    .source = "Hooke's law for a flexible cable carrier",
    .parameters = parameters,
    .apply = apply,
};

}  // namespace fidservo::plant::effects
