// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/effects/effect.h"

namespace fidservo::plant::effects {

namespace {

/// It hides within the counts up to where the carriage has gone too far for that.
constexpr double factors[] = {1.01, 1.001, 0.999};

constexpr EffectParameter parameters[] = {
    parameter::size({"factor", "", 0.8, 1.25, 1.0, 1.01, "length of a count per nominal length"}, factors),
};

void apply(PlantParameters& plant, std::span<const double> values) {
    plant.encoder.resolution_mm *= values[0];
}

}  // namespace

extern constexpr Effect encoder_scale{
    .name = "encoder_scale",
    .block = "macro.encoder",
    .part = Part::encoder,
    .text = "Counts are not the nominal length: resolution = factor * nominal.",
    .source = "Linear encoders' scale error, e.g. ISO 230-2",
    .parameters = parameters,
    .apply = apply,
};

}  // namespace fidservo::plant::effects
