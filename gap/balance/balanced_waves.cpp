// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/balance/balanced_waves.h"

#include "core/parallel.h"
#include "core/rig.h"
#include "core/units.h"
#include "gap/balance/balance_fit.h"
#include "gap/numbers.h"
#include "plant/effects/catalogue.h"
#include "plant/stage_plant.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

namespace fidservo::gap {

plant::EffectSetting wave_at(const Candidate& candidate, const PositionPeriod& period) {
    std::vector<double> values = candidate.shapes.front();
    const plant::EffectParameter& amplitude = candidate.effect->parameters[candidate.wave->amplitude];
    const bool is_force = candidate.wave->is_force;
    const Wave& wave = is_force ? period.force_V : period.reading_mm;
    values[candidate.wave->amplitude] =
        std::clamp((is_force ? 1.0 : um_per_mm) * wave.amplitude, amplitude.low, amplitude.high);
    values[candidate.wave->period] = period.period_mm;
    values[candidate.wave->phase] = std::remainder(wave.phase_rad, 2.0 * std::numbers::pi);
    return {candidate.effect, std::move(values)};
}

std::vector<PositionPeriod> on_the_rail(std::vector<PositionPeriod> periods, const Rig& rig,
                                        const Hypothesis& hypothesis) {
    plant::PlantParameters parameters = plant::plant_parameters(rig);
    plant::apply_effects(parameters, hypothesis);
    const double stretch = parameters.encoder.resolution_mm / rig.macro.encoder_resolution_mm;
    for (PositionPeriod& period : periods) {
        period.period_mm *= stretch;
        period.reading_mm.amplitude *= stretch;
    }
    return periods;
}

std::vector<plant::EffectSetting> balanced_waves(const Evidence& evidence, const Wanted& wanted,
                                                 const Hypothesis& base, const Candidate& candidate,
                                                 std::span<const PositionPeriod> periods) {
    constexpr std::size_t most_waves = 2;
    constexpr double most_of_harmonic = larger_part;  // of the wave; a stronger one is noise, as a rule
    if (!candidate.wave || !candidate.wave->is_force) return {};
    const ForceBalance balance(evidence, wanted, base);
    if (balance.supports() == 0) return {};
    const BalanceFit balanced(balance, wanted, base);
    std::vector<Fit> fits(std::min(most_fitted_forms, periods.size()));
    parallel_for(fits.size(),
                 [&](std::size_t k) { fits[k] = balanced.fit({wave_at(candidate, periods[k])}); });
    std::ranges::sort(fits, {}, &Fit::loss);
    if (fits.size() > most_waves) fits.resize(most_waves);
    const std::vector<Refinement> harmonic = refinements_of(*candidate.effect);
    std::vector<Fit> with_harmonic(harmonic.empty() ? 0 : fits.size());
    parallel_for(with_harmonic.size(), [&](std::size_t k) {
        Hypothesis start = fits[k].hypothesis;
        for (const Refinement& part : harmonic) start.front().values[part.parameter] = part.values.back();
        with_harmonic[k] = balanced.fit(start);
    });
    std::erase_if(with_harmonic, [&](const Fit& fit) {
        return std::ranges::any_of(harmonic, [&](const Refinement& part) {
            return std::abs(fit.hypothesis.front().values[part.parameter]) > most_of_harmonic;
        });
    });
    std::ranges::move(with_harmonic, std::back_inserter(fits));
    std::ranges::sort(fits, {}, &Fit::loss);
    std::vector<plant::EffectSetting> waves;
    waves.reserve(fits.size());
    for (Fit& fit : fits) waves.push_back(std::move(fit.hypothesis.front()));
    return waves;
}

}  // namespace fidservo::gap
