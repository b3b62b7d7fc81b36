#include "plant/effects/effect.h"

namespace fidservo::plant::effects {

namespace {

constexpr EffectParameter parameters[] = {
    {"coupling", "", 0.0, 2.0, 0.0, 0.25, "what the mass gives back, as conductance per that to the room"},
    {"mass_tau_s", "s", 1.0, 300.0, 20.0, 20.0, "time constant of the mass"},
    {"taken", "", 0.0, 20.0, 1.0, 1.0,
     "what the mass takes per what it gives back; 1: it loses heat to the wire only; 0: it is the wire's "
     "surroundings"},
    {"heating", "", 1.0, 2.6, 1.0, 1.0, "conductance while the wire heats, per that while it cools", 0.02},
    {"diffusion_s", "s", 0.0, 10.0, 0.0, 0.0,
     "the mass's length^2 over its diffusivity; 0: of one temperature", 0.25},
};

void apply(PlantParameters& plant, std::span<const double> values) {
    plant.micro->mass = {values[0], values[1], values[2], parameters[3].acting(values[3]),
                         parameters[4].acting(values[4])};
}

}  // namespace

extern constexpr Effect second_thermal_mass{
    .name = "second_thermal_mass",
    .block = "micro.heater",
    .text =
        "Plates or the mount store heat and slow the cooling later on. With q, b the rise of wire and "
        "mass above the room: dq/dt = (phi - q) / tau - coupling / tau_c (taken q - b), mass_tau db/dt = "
        "q - b; tau is the heating time constant while phi > q, else the cooling one, tau_c. What is not "
        "taken warms the wire's surroundings (plant/thermal_pair.h). A mass that conducts is a rod of three "
        "parts (plant/thermal_rod.h).",
    .source =
        "Incropera, DeWitt, Fundamentals of Heat and Mass Transfer, 6th ed., 2007, ch. 5: two lumped "
        "capacitances",
    .parameters = parameters,
    .apply = apply,
};

}  // namespace fidservo::plant::effects
