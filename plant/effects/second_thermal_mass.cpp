#include "plant/effects/effect.h"

namespace fidservo::plant::effects {

namespace {

constexpr EffectParameter parameters[] = {
    {"coupling", "", 0.0, 2.0, 0.0, 0.25, "conductance to the mass per conductance to the room"},
    {"mass_tau_s", "s", 1.0, 300.0, 20.0, 20.0, "time constant of the mass"},
    {"retention", "", 0.0, 1.0, 1.0, 1.0,
     "steady rise of the mass per rise of the wire; 1: it loses heat to the wire only"},
};

void apply(PlantParameters& plant, std::span<const double> values) {
    plant.micro->mass = {values[0], values[1], values[2]};
}

}  // namespace

extern constexpr Effect second_thermal_mass{
    .name = "second_thermal_mass",
    .block = "micro.heater",
    .text =
        "Plates or the mount store heat and slow the cooling later on. With q, b the rise of wire and "
        "mass above the room: dq/dt = (phi - q) / tau - coupling / tau_c (q - b), mass_tau db/dt = "
        "retention q - b; tau is the heating time constant while phi > q, else the cooling one, tau_c.",
    .source =
        "Incropera, DeWitt, Fundamentals of Heat and Mass Transfer, 6th ed., 2007, ch. 5: two lumped "
        "capacitances",
    .parameters = parameters,
    .apply = apply,
};

}  // namespace fidservo::plant::effects
