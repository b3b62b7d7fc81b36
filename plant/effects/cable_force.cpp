// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/effects/effect.h"

namespace fidservo::plant::effects {

extern const Effect drive_offset;

namespace {

constexpr EffectParameter parameters[] = {
    {"stiffness_V_per_mm", "V/mm", 0.0, 0.05, 0.0, 0.002, "of the spring"},
    parameter::with_role(
        {"centre_mm", "mm", -1000.0, 1000.0, 100.0, 100.0, "where the harness does not pull"}, Role::place),
    parameter::optional(
        {"hardening", "", 0.0, 20.0, 0.0, 0.0, "by how much more it pulls per mm, 100 mm from there"}, 0.1),
};

void apply(PlantParameters& plant, std::span<const double> values) {
    plant.axis.standing.cable_V_per_mm += values[0];
    plant.axis.standing.cable_centre_mm = values[1];
    plant.axis.standing.cable_hardening = parameters[2].acting(values[2]);
}

double pull_in_the_middle(std::span<const double> values, double middle_mm) {
    return values[0] * (values[1] - middle_mm);
}

}  // namespace

extern constexpr Effect cable_force{
    .name = "cable_force",
    .block = "macro.mechanics",
    .part = Part::carriage,
    .text =
        "The cable harness pulls like a spring that may harden: w = u - k d (1 + hardening (d / 100 mm)^2), "
        "d = y - y0, before the dead zone, which holds it while the carriage stands.",
    .source = "Hooke's law for a flexible cable carrier; Duffing, Erzwungene Schwingungen, 1918: hardening",
    .parameters = parameters,
    .apply = apply,
    .needs_place = true,
    .plainer = {&drive_offset, pull_in_the_middle},  // of a long spring
};

}  // namespace fidservo::plant::effects
