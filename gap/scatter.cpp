#include "gap/scatter.h"

#include "core/random.h"
#include "gap/balanced_springs.h"
#include "gap/score.h"
#include "gap/wave.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace fidservo::gap {
namespace {

/// Standard deviations of what is drawn first.
constexpr double size_shares = 0.5, phase_rad = 0.5, waves_per_mm = 0.25 / 200.0, harmonic_shares = 0.15,
                 centre_mm = 30.0, hardening_shares = 0.7, least_hardening = 0.5;

double within(const plant::EffectParameter& parameter, double value) {
    return std::clamp(value, parameter.low, parameter.high);
}

plant::EffectSetting drawn_wave(const plant::EffectSetting& around, double radius, NoiseStream& draw) {
    plant::EffectSetting there = around;
    const WaveParameters wave = *wave_of(*there.effect);
    const auto& parameters = there.effect->parameters;
    double &amplitude = there.values[wave.amplitude], &period_mm = there.values[wave.period],
           &phase = there.values[wave.phase];
    amplitude =
        within(parameters[wave.amplitude], amplitude * std::exp(radius * size_shares * draw.normal()));
    phase += radius * phase_rad * draw.normal();
    const double before_mm = period_mm;
    period_mm = within(parameters[wave.period],
                       1.0 / std::max(1.0 / before_mm + radius * waves_per_mm * draw.normal(), 1e-6));
    phase = phase_in_step(phase, before_mm, period_mm);
    for (const Refinement& harmonic : refinements_of(*there.effect)) {
        double& share = there.values[harmonic.parameter];
        share = within(parameters[harmonic.parameter], share + radius * harmonic_shares * draw.normal());
    }
    return there;
}

plant::EffectSetting drawn_spring(const plant::EffectSetting& around, double radius, NoiseStream& draw) {
    plant::EffectSetting there = around;
    const auto& parameters = there.effect->parameters;
    double &stiffness = there.values[0], &middle_mm = there.values[1];
    stiffness = within(parameters[0], stiffness * std::exp(radius * size_shares * draw.normal()));
    middle_mm = within(parameters[1], middle_mm + radius * centre_mm * draw.normal());
    for (const Refinement& refinement : refinements_of(*there.effect)) {
        double& hardening = there.values[refinement.parameter];
        const double width = radius * hardening_shares * std::max(hardening, least_hardening);
        hardening = within(parameters[refinement.parameter], hardening + width * draw.normal());
    }
    return there;
}

/// A wave with any harmonic: of a few strengths, all around.
std::vector<plant::EffectSetting> with_harmonics(const plant::EffectSetting& wave) {
    constexpr int phases = 8;
    const std::vector<Refinement> parts = refinements_of(*wave.effect);
    std::vector<plant::EffectSetting> all;
    if (!wave_of(*wave.effect) || parts.size() != 2) return all;
    for (const double share : {0.06, 0.12, 0.22})
        for (int k = 0; k < phases; ++k) {
            const double angle_rad = 2.0 * std::numbers::pi * k / phases;
            all.push_back(wave);
            all.back().values[parts[0].parameter] = share * std::cos(angle_rad);
            all.back().values[parts[1].parameter] = share * std::sin(angle_rad);
        }
    return all;
}

}  // namespace

bool has_valleys(const Candidate& candidate) {
    return candidate.wave || is_spring(*candidate.effect);
}

Fit scatter(const Predict& predict, std::span<const Window> windows, const Wanted& counted,
            const Hypothesis& start, std::size_t place) {
    constexpr int draws = 40;
    const auto drawn = wave_of(*start[place].effect) ? drawn_wave : drawn_spring;
    Fit best{start, total_loss(windows, counted, predict(start)), {}};
    NoiseStream draw(1, "wave");
    Fit found = best;
    const auto try_out = [&](plant::EffectSetting setting) {
        Hypothesis there = best.hypothesis;
        there[place] = std::move(setting);
        const double loss = total_loss(windows, counted, predict(there));
        if (loss < found.loss) found = {std::move(there), loss, {}};
    };
    for (const double radius : {1.0, 0.4, 0.15, 0.05}) {
        // What is nearly right may lack its harmonic alone.
        for (plant::EffectSetting& there : with_harmonics(best.hypothesis[place])) try_out(std::move(there));
        best = found;
        for (int k = 0; k < draws; ++k) try_out(drawn(best.hypothesis[place], radius, draw));
        best = found;
    }
    return best;
}

}  // namespace fidservo::gap
