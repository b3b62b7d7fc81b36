#include "gap/balanced_waves.h"

#include "gap/balance_fit.h"
#include "gap/parallel.h"
#include "gap/score.h"
#include "gap/wave_starts.h"

#include <algorithm>

namespace fidservo::gap {

std::vector<plant::EffectSetting> balanced_waves(const Evidence& evidence, const Wanted& wanted,
                                                 const Hypothesis& base, const Candidate& candidate,
                                                 std::span<const PositionPeriod> periods) {
    constexpr std::size_t most_fitted = 4, most_waves = 2;
    if (!candidate.wave || candidate.effect->parameters[candidate.wave->amplitude].unit != "V") return {};
    const ForceBalance balance(evidence, wanted);
    if (balance.supports().empty()) return {};
    const BalanceFit balanced(balance, evidence.windows(), wanted, base);
    std::vector<Fit> fits(std::min(most_fitted, periods.size()));
    parallel_for(fits.size(),
                 [&](std::size_t k) { fits[k] = balanced.fit({wave_at(candidate, periods[k])}); });
    std::ranges::sort(fits, {}, &Fit::loss);
    if (fits.size() > most_waves) fits.resize(most_waves);
    const std::vector<Refinement> harmonic = refinements_of(*candidate.effect);
    parallel_for(harmonic.empty() ? 0 : fits.size(), [&](std::size_t k) {
        Hypothesis start = fits[k].hypothesis;
        for (const Refinement& part : harmonic) start.front().values[part.parameter] = part.values.back();
        Fit with = balanced.fit(start);
        if (with.loss < fits[k].loss - least_gain) fits[k] = std::move(with);
    });
    std::ranges::sort(fits, {}, &Fit::loss);
    std::vector<plant::EffectSetting> waves;
    waves.reserve(fits.size());
    for (Fit& fit : fits) waves.push_back(std::move(fit.hypothesis.front()));
    return waves;
}

}  // namespace fidservo::gap
