#include "plant/effects/effect.h"

namespace fidservo::plant::effects {

namespace {

constexpr EffectParameter parameters[] = {
    {"offset_V", "V", -1.0, 1.0, 0.0, 0.02, "voltage above nominal"},
};

void apply(PlantParameters& plant, std::span<const double> values) {
    plant.micro->hall.mid_V += values[0];
}

}  // namespace

extern constexpr Effect hall_offset{
    .name = "hall_offset",
    .block = "micro.hall",
    .text = "The sensor's zero differs: V = nominal V + offset.",
    .source = "Ramsden, Hall-Effect Sensors, 2nd ed., 2006: quiescent output voltage",
    .parameters = parameters,
    .apply = apply,
};

}  // namespace fidservo::plant::effects
