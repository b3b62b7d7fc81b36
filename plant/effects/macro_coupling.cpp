#include "plant/effects/effect.h"

namespace fidservo::plant::effects {

namespace {

constexpr EffectParameter parameters[] = {
    {"gain", "", -2.0, 2.0, 0.0, 0.5,
     "share of the carriage's acceleration that deflects the platform; negative: forwards, as on a lever"},
    {"frequency_Hz", "Hz", 5.0, 200.0, 30.0, 30.0, "undamped resonance of the platform"},
    {"damping_ratio", "", 0.001, 0.9, 0.05, 0.05, "1: no oscillation"},
};

void apply(PlantParameters& plant, std::span<const double> values) {
    plant.micro->swing = {values[1], values[2], values[0]};
}

}  // namespace

extern constexpr Effect macro_coupling{
    .name = "macro_coupling",
    .block = "micro.mechanics",
    .text =
        "The carriage's acceleration a swings the flexure platform: d2z/dt2 + 2 zeta w dz/dt + w^2 z "
        "= -gain a, w = 2 pi frequency; z adds to the platform's position, for the Hall sensor and "
        "the camera alike.",
    .source =
        "Meirovitch, Fundamentals of Vibrations, 2001, ch. 3: base excitation of a damped oscillator; "
        "Howell, Compliant Mechanisms, 2001: flexures",
    .parameters = parameters,
    .apply = apply,
};

}  // namespace fidservo::plant::effects
