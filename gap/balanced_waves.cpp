#include "gap/balanced_waves.h"

#include "gap/balance_fit.h"
#include "gap/parallel.h"
#include "gap/wave_starts.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace fidservo::gap {

std::vector<plant::EffectSetting> balanced_waves(const Evidence& evidence, const Wanted& wanted,
                                                 const Hypothesis& base, const Candidate& candidate,
                                                 std::span<const PositionPeriod> periods) {
    constexpr std::size_t most_fitted = 4, most_waves = 2;
    constexpr double most_of_harmonic = 0.5;  // of the wave; a stronger one is noise, as a rule
    if (!candidate.wave || !candidate.wave->is_force) return {};
    const ForceBalance balance(evidence, wanted);
    if (balance.supports().empty()) return {};
    const BalanceFit balanced(balance, evidence.windows(), wanted, base);
    std::vector<Fit> fits(std::min(most_fitted, periods.size()));
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
