#include "plant/effects/effect.h"

namespace fidservo::plant::effects {

namespace {

constexpr EffectParameter parameters[] = {
    {"cubic_shift", "", -0.3, 0.3, 0.0, 0.03, "added to the curve's cubic coefficient"},
};

void apply(PlantParameters& plant, std::span<const double> values) {
    plant.micro->hall.cubic += values[0];
}

}  // namespace

extern constexpr Effect hall_nonlinearity{
    .name = "hall_nonlinearity",
    .block = "micro.hall",
    .text =
        "The sensor's curve is more or less S-shaped: V = mid + span s (1 + (nominal cubic + shift) (1 - "
        "s^2)); centre and ends of the range stay.",
    .source = "Ramsden, Hall-Effect Sensors, 2nd ed., 2006: non-linearity of a sliding magnet's field",
    .parameters = parameters,
    .apply = apply,
};

}  // namespace fidservo::plant::effects
