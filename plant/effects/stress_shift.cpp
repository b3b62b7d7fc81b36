// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/effects/effect.h"

namespace fidservo::plant::effects {

extern const Effect ambient_temperature;

namespace {

constexpr EffectParameter parameters[] = {
    {"shift_degC", "degC", -40.0, 40.0, 0.0, 6.0, "of all transformation temperatures, upwards with load"},
    // The reference rig's wire contracts by 0.21 mm/degC at most: at 4.7 degC/mm it would snap.
    {"spring_degC_per_mm", "degC/mm", -4.0, 4.0, 0.0, 0.0,
     "further with each mm of contraction, as a spring loads the wire"},
};

void apply(PlantParameters& plant, std::span<const double> values) {
    plant.micro->table_shift_degC += values[0];
    plant.micro->table_shift_degC_per_mm += values[1];
}

}  // namespace

extern constexpr Effect stress_shift{
    .name = "stress_shift",
    .block = "micro.hysteresis",
    .part = Part::wire,
    .text =
        "Load on the wire moves its transformation temperatures by (load stress - nominal stress) / "
        "C, C some 7 MPa/degC for NiTi: x = f(T - shift - spring x), with a part that a stiffer spring "
        "brings as the wire contracts. A warmer room does the same as a constant shift, with the other "
        "sign.",
    .source =
        "Clausius-Clapeyron relation for martensitic transformations: Wollants, De Bonte, Roos, Z. "
        "Metallkunde 70, 1979; Otsuka, Wayman (eds.), Shape Memory Materials, 1998, ch. 1",
    .parameters = parameters,
    .apply = apply,
    .same_as = &ambient_temperature,  // both move the wire's temperature against the table
};

}  // namespace fidservo::plant::effects
