// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/effects/effect.h"

namespace fidservo::plant::effects {

namespace {

constexpr EffectParameter parameters[] = {
    {"amplitude_V", "V", 0.0, 2.0, 0.0, 0.1, "of the force"},
    parameter::with_role({"period_mm", "mm", 0.1, 200.0, 5.0, 5.0, "on the rail"}, Role::period),
    parameter::with_role({"phase_rad", "rad", -6.2831853072, 6.2831853072, 0.0, 0.0, "at the left end"},
                         Role::phase),
    parameter::optional({"second_sine", "", -1.0, 1.0, 0.0, 0.0, "of the second harmonic, per amplitude"},
                        0.001),
    parameter::optional({"second_cosine", "", -1.0, 1.0, 0.0, 0.0, "the same, a quarter of its wave on"},
                        0.001),
};

void apply(PlantParameters& plant, std::span<const double> values) {
    StandingForce& force = plant.axis.standing;
    force.cogging_V += values[0];
    force.cogging_period_mm = values[1];
    force.cogging_phase_rad = values[2];
    force.cogging_second_sine = parameters[3].acting(values[3]);
    force.cogging_second_cosine = parameters[4].acting(values[4]);
}

}  // namespace

extern constexpr Effect cogging{
    .name = "cogging",
    .block = "macro.mechanics",
    .part = Part::carriage,
    .text =
        "A force periodic in position (detent torque of the motor): w = u + A sin(2 pi y / p + phase), "
        "perhaps with a second harmonic, before the dead zone, which holds it while the carriage stands.",
    .source = "Hanselman, Brushless Permanent Magnet Motor Design, 2nd ed., 2003: cogging torque",
    .parameters = parameters,
    .apply = apply,
};

}  // namespace fidservo::plant::effects
