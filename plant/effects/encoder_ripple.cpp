// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/effects/effect.h"

namespace fidservo::plant::effects {

namespace {

constexpr EffectParameter parameters[] = {
    {"amplitude_um", "um", 0.0, 1000.0, 0.0, 50.0, "of the error"},
    parameter::with_role({"period_mm", "mm", 0.1, 200.0, 5.0, 5.0, "on the rail"}, Role::period),
    parameter::with_role({"phase_rad", "rad", -6.2831853072, 6.2831853072, 0.0, 0.0, "at the left end"},
                         Role::phase),
};

void apply(PlantParameters& plant, std::span<const double> values) {
    EncoderRipple& ripple = plant.encoder.ripple;
    ripple.amplitude_mm += 1e-3 * values[0];
    ripple.period_mm = values[1];
    ripple.phase_rad = values[2];
}

}  // namespace

extern constexpr Effect encoder_ripple{
    .name = "encoder_ripple",
    .block = "macro.encoder",
    .part = Part::encoder,
    .text = "A reading error periodic in position: it reads y + A sin(2 pi y / p + phase).",
    .source =
        "Linear encoders' subdivisional and graduation error, e.g. Merry, van de Molengraft, Steinbuch, "
        "Mechatronics 20, 2010",
    .parameters = parameters,
    .apply = apply,
};

}  // namespace fidservo::plant::effects
