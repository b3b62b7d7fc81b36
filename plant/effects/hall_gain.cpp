#include "plant/effects/effect.h"

namespace fidservo::plant::effects {

namespace {

constexpr EffectParameter parameters[] = {
    {"factor", "", 0.5, 1.5, 1.0, 1.02, "slope per nominal slope"},
};

void apply(PlantParameters& plant, std::span<const double> values) {
    plant.micro->hall.span_V *= values[0];
}

}  // namespace

extern constexpr Effect hall_gain{
    .name = "hall_gain",
    .block = "micro.hall",
    .text = "The sensor's slope differs by a factor: V = mid + factor * (nominal V - mid).",
    .source = "Ramsden, Hall-Effect Sensors, 2nd ed., 2006: sensitivity spread",
    .parameters = parameters,
    .apply = apply,
};

}  // namespace fidservo::plant::effects
