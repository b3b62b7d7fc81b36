// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/effects/effect.h"

namespace fidservo::plant::effects {

namespace {

/// What a stretch does grows with it only as long as the carriage swings on the belt with about the same
/// frequency.
constexpr double stretches_um_per_V[] = {200.0, 800.0};

constexpr EffectParameter parameters[] = {
    parameter::size({"stretch_um_per_V", "um/V", 0.0, 5000.0, 0.0, 50.0,
                     "stretch per volt of force; below 0.1 the belt counts as stiff"},
                    stretches_um_per_V),
    parameter::shape({"damping_ratio", "", 0.0, 2.0, 0.05, 0.05, "of the swing of motor and carriage"}),
    parameter::shape({"motor_share", "", 0.1, 0.9, 0.5, 0.5, "of the moving mass; the rest is the carriage"}),
};

void apply(PlantParameters& plant, std::span<const double> values) {
    plant.axis.belt = {plant.axis.belt.compliance_mm_per_V + 1e-3 * values[0], values[1], values[2]};
}

}  // namespace

extern constexpr Effect belt_compliance{
    .name = "belt_compliance",
    .block = "macro.mechanics",
    .part = Part::carriage,
    .text =
        "The belt stretches: motor (share m of the mass, voltage and back-EMF) and carriage (friction, "
        "encoder) are "
        "joined by a damped spring, w^2 = K / (C m (1 - m) tau); see plant/transmission.h. The linear "
        "encoder sits on the "
        "carriage.",
    .source = "Two-mass drive, e.g. Vukosavic, Stojic, IEEE Trans. Ind. Electron. 45(5), 1998",
    .parameters = parameters,
    .apply = apply,
};

}  // namespace fidservo::plant::effects
