// SPDX-License-Identifier: GPL-3.0-or-later
// An effect and its simpler form, each fitted from the other's values.
#include "core/parallel.h"
#include "core/rig.h"
#include "gap/search/contender.h"
#include "gap/search/search.h"

#include <algorithm>
#include <functional>
#include <utility>

namespace fidservo::gap {

void Search::fit_plain_form(const CrossFit& base, const Contender& richer, Contender& plain) const {
    if (plain.coupled != richer.coupled) return;
    Finding finding = *plain.finding;
    Contender found = plain;
    found.finding = &finding;
    parallel_for(2, [&](std::size_t side) {
        Hypothesis start = richer.trial.fitted.of_half[side];
        start.back() = plain_form(start.back(), fitter_.evidence().rig().macro);
        found.trial.fitted.of_half[side] =
            fitter_.fit_places(side, start, plain.fitted_places(base), base.mean_squares).hypothesis;
        finding.fitted[side] = found.part(found.trial.fitted.of_half[side]);
    });
    finding.sought = Sought::nowhere;
    judge_both_halves(base, found);
    if (found.gain() <= plain.gain()) return;
    *plain.finding = std::move(finding);
    plain.trial = std::move(found.trial);
}

void Search::fit_rich_form(const CrossFit& base, const Contender& plain, Contender& richer) const {
    if (plain.coupled != richer.coupled) return;
    const CrossFit& known = plain.trial.fitted;
    const Places places = richer.fitted_places(base);
    std::vector<Fit> attempts;
    for (plant::EffectSetting& form : rich_forms(known.of_half[0].back(), *richer.trial.candidate)) {
        attempts.push_back({.hypothesis = known.of_half[0], .loss = 0.0, .covariance = {}});
        attempts.back().hypothesis.back() = std::move(form);
    }
    if (attempts.empty()) return;
    parallel_for(attempts.size(), [&](std::size_t k) {
        attempts[k] = fitter_.fit_places(0, attempts[k].hypothesis, places, known.mean_squares,
                                         {.most_iterations = few_iterations});
    });
    const Hypothesis& start = std::ranges::min_element(attempts, {}, &Fit::loss)->hypothesis;
    Finding finding = *richer.finding;
    Contender from = richer;
    from.finding = &finding;
    from.trial.fitted = known;
    finding.fitted[0] = richer.part(start);
    Contender found = fitted_on(base, from, start);
    if (found.gain() <= richer.gain()) return;
    for (std::size_t side = 0; side < 2; ++side)
        finding.fitted[side] = found.part(found.trial.fitted.of_half[side]);
    finding.sought = Sought::nowhere;
    *richer.finding = std::move(finding);
    richer.trial = std::move(found.trial);
}

std::span<Search::Contender> Search::with_fitted(std::span<Contender> all, std::size_t leaders,
                                                 const std::function<bool(Contender&)>& fit) {
    const double least_gain_of_leader = share_of_gain * all.front().gain();
    for (std::size_t k = 1; k < all.size(); ++k)
        if (fit(all[k]) && k >= leaders && all[k].trial.is_leader && all[k].gain() > least_gain_of_leader)
            std::swap(all[k], all[leaders++]);
    std::ranges::sort(all.first(leaders), std::greater{}, &Contender::gain);
    return all.first(leaders);
}

std::span<Search::Contender> Search::with_limits(const CrossFit& base, std::span<Contender> all,
                                                 std::size_t leaders) const {
    const Contender best = all.front();
    return with_fitted(all, leaders, [&](Contender& plain) {
        if (!is_limit_of(*plain.trial.candidate->effect, *best.trial.candidate->effect)) return false;
        fit_plain_form(base, best, plain);
        return true;
    });
}

std::span<Search::Contender> Search::with_richer(const CrossFit& base, std::span<Contender> all,
                                                 std::size_t leaders) const {
    const Contender best = all.front();
    if (!meet(off(best.trial.fitted), best.teachers())) return all.first(leaders);
    return with_fitted(all, leaders, [&](Contender& richer) {
        if (!is_limit_of(*best.trial.candidate->effect, *richer.trial.candidate->effect)) return false;
        fit_rich_form(base, best, richer);
        return true;
    });
}

}  // namespace fidservo::gap
