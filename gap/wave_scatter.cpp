#include "gap/wave_scatter.h"

#include "core/random.h"
#include "gap/candidate.h"
#include "gap/score.h"
#include "gap/wave.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fidservo::gap {
namespace {

/// Standard deviations of what is drawn first.
constexpr double amplitude_shares = 0.5, phase_rad = 0.5, waves_per_mm = 0.25 / 200.0, harmonic_shares = 0.15;

plant::EffectSetting drawn(const plant::EffectSetting& around, const WaveParameters& wave, double radius,
                           NoiseStream& draw) {
    plant::EffectSetting there = around;
    double &amplitude = there.values[wave.amplitude], &period_mm = there.values[wave.period],
           &phase = there.values[wave.phase];
    const auto within = [&](std::size_t k, double value) {
        const plant::EffectParameter& parameter = there.effect->parameters[k];
        return std::clamp(value, parameter.low, parameter.high);
    };
    amplitude = within(wave.amplitude, amplitude * std::exp(radius * amplitude_shares * draw.normal()));
    phase += radius * phase_rad * draw.normal();
    const double before_mm = period_mm;
    period_mm =
        within(wave.period, 1.0 / std::max(1.0 / before_mm + radius * waves_per_mm * draw.normal(), 1e-6));
    phase = phase_in_step(phase, before_mm, period_mm);
    for (const Refinement& harmonic : refinements_of(*there.effect)) {
        double& share = there.values[harmonic.parameter];
        share = within(harmonic.parameter, share + radius * harmonic_shares * draw.normal());
    }
    return there;
}

}  // namespace

Fit scatter_wave(const Predict& predict, std::span<const Window> windows, const Wanted& counted,
                 const Hypothesis& start, std::size_t place) {
    constexpr int draws = 60;
    const WaveParameters wave = *wave_of(*start[place].effect);
    Fit best{start, total_loss(windows, counted, predict(start)), {}};
    NoiseStream draw(1, "wave");
    for (const double radius : {1.0, 0.4, 0.15, 0.05}) {
        Fit found = best;
        for (int k = 0; k < draws; ++k) {
            Hypothesis there = best.hypothesis;
            there[place] = drawn(there[place], wave, radius, draw);
            const double loss = total_loss(windows, counted, predict(there));
            if (loss < found.loss) found = {std::move(there), loss, {}};
        }
        best = std::move(found);
    }
    return best;
}

}  // namespace fidservo::gap
