#include "plant/effects/effect.h"

namespace fidservo::plant::effects {

namespace {

constexpr EffectParameter parameters[] = {
    {"level_V", "V", 0.0, 3.0, 0.0, 0.2, "friction at the lowest speeds beyond that at high speed"},
    {"speed_mm_per_s", "mm/s", 0.5, 300.0, 12.0, 12.0, "at which it has fallen to 1/e"},
    {"creep_mm_per_s", "mm/s", 0.0, 5.0, 0.0, 0.0,
     "below which it lets the carriage creep; less than 0.03, half a count a second: it holds it at rest"},
};

/// What creeps more slowly is stiff to follow and moves less than is seen.
constexpr double least_creep_mm_per_s = 0.03;

void apply(PlantParameters& plant, std::span<const double> values) {
    Friction& friction = plant.axis.friction;
    friction.stribeck_V += values[0];
    friction.stribeck_mm_per_s = values[1];
    if (values[0] != 0.0) friction.creep_mm_per_s = values[2] < least_creep_mm_per_s ? 0.0 : values[2];
}

}  // namespace

extern constexpr Effect stribeck_friction{
    .name = "stribeck_friction",
    .block = "macro.friction",
    .text =
        "Friction rises towards low speed: F = Fs exp(-|v| / vs) sgn(v), which holds a carriage at rest "
        "while |V| "
        "is not above Fs. With a creep speed vc, tanh(v / vc) stands for sgn(v), and nothing is held.",
    .source = "Tustin, J. IEE 94(2A), 1947: exponent 1; Andersson et al., Tribology Int. 40, 2007: tanh",
    .parameters = parameters,
    .apply = apply,
};

}  // namespace fidservo::plant::effects
