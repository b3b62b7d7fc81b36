// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/balance/balanced_springs.h"

#include "core/parallel.h"
#include "gap/balance/balance_fit.h"

#include <algorithm>
#include <utility>

namespace fidservo::gap {
namespace {

Fit best_balanced(const BalanceFit& balanced, std::span<const Hypothesis> starts) {
    std::vector<Fit> fits(starts.size());
    parallel_for(fits.size(), [&](std::size_t k) { fits[k] = balanced.fit(starts[k]); });
    return *std::ranges::min_element(fits, {}, &Fit::loss);
}

/// A spring with each of the parameters that it may be without, at any of their values, as strong as it is
/// and with less of the pull nearby, which its hardening then adds to.
std::vector<plant::EffectSetting> richer_forms(const plant::EffectSetting& plain) {
    constexpr double nearby = 0.3;
    std::vector<plant::EffectSetting> forms;
    for (const Refinement& refinement : refinements_of(*plain.effect))
        for (const double value : refinement.values) {
            forms.push_back(plain);
            forms.back().values[refinement.parameter] = value;
            forms.push_back(forms.back());
            forms.back().values.front() *= nearby;
        }
    return forms;
}

}  // namespace

bool is_spring(const plant::Effect& effect) {
    return effect.place_of(plant::Role::place) && !effect.place_of(plant::Role::width);
}

std::vector<plant::EffectSetting> balanced_springs(const Evidence& evidence, const Wanted& wanted,
                                                   const Hypothesis& base, const Candidate& candidate) {
    if (!is_spring(*candidate.effect)) return {};
    const ForceBalance balance(evidence, wanted, base);
    if (balance.supports() == 0) return {};
    const BalanceFit balanced(balance, wanted, base);
    std::vector<Hypothesis> starts;
    for (const std::vector<double>& shape : candidate.shapes) starts.push_back({{candidate.effect, shape}});
    const plant::EffectSetting plain = best_balanced(balanced, starts).hypothesis.front();
    starts.clear();
    for (plant::EffectSetting& form : richer_forms(plain)) starts.push_back({std::move(form)});
    if (starts.empty()) return {plain};
    return {plain, best_balanced(balanced, starts).hypothesis.front()};
}

}  // namespace fidservo::gap
