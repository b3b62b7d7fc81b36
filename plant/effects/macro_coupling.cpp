// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/effects/effect.h"

#include <array>

namespace fidservo::plant::effects {

namespace {

/// Start values. A strongly damped oscillator predicts only the first swings after each step of the carriage,
/// and predicts them at any frequency near the true one, so that a fit finds the frequency first and lowers
/// the damping then. The frequencies of the grid differ by the relative width 2 zeta of such a resonance.
constexpr double damping_ratios[] = {0.2};
constexpr std::array frequencies_Hz = [] {
    constexpr double ratio = 1.0 + 2.0 * damping_ratios[0];
    std::array<double, 11> frequencies{};
    double frequency_Hz = 6.0;
    for (double& each : frequencies) {
        each = frequency_Hz;
        frequency_Hz *= ratio;
    }
    return frequencies;
}();

constexpr EffectParameter parameters[] = {
    {"gain", "", -2.0, 2.0, 0.0, 0.5,
     "share of the carriage's acceleration that deflects the platform; negative: forwards, as on a lever"},
    parameter::shape({"frequency_Hz", "Hz", 5.0, 200.0, 30.0, 30.0, "undamped resonance of the platform"},
                     frequencies_Hz),
    parameter::shape({"damping_ratio", "", 0.001, 0.9, 0.05, 0.05, "1: no oscillation"}, damping_ratios),
};

void apply(PlantParameters& plant, std::span<const double> values) {
    plant.micro->swing = {values[1], values[2], values[0]};
}

}  // namespace

extern constexpr Effect macro_coupling{
    .name = "macro_coupling",
    .block = "micro.mechanics",
    .part = Part::platform,
    .text =
        "The carriage's acceleration a swings the flexure platform: d2z/dt2 + 2 zeta w dz/dt + w^2 z "
        "= -gain a, w = 2 pi frequency; z adds to the platform's position, for the Hall sensor and "
        "the camera alike.",
    .source =
        "Meirovitch, Fundamentals of Vibrations, 2001, ch. 3: base excitation of a damped oscillator; "
        "Howell, Compliant Mechanisms, 2001: flexures",
    .parameters = parameters,
    .apply = apply,
    .again = Again::replaces,
};

}  // namespace fidservo::plant::effects
