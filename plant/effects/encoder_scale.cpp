#include "plant/effects/effect.h"

namespace fidservo::plant::effects {

namespace {

constexpr EffectParameter parameters[] = {
    {"factor", "", 0.8, 1.25, 1.0, 1.01, "length of a count per nominal length"},
};

void apply(PlantParameters& plant, std::span<const double> values) {
    plant.encoder.resolution_mm *= values[0];
}

}  // namespace

extern constexpr Effect encoder_scale{
    .name = "encoder_scale",
    .block = "macro.encoder",
    .text = "Counts are not the nominal length: resolution = factor * nominal.",
    .source = "Linear encoders' scale error, e.g. ISO 230-2",
    .parameters = parameters,
    .apply = apply,
};

}  // namespace fidservo::plant::effects
