// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/search/exchange.h"

#include "gap/fit/gap_size.h"
#include "gap/numbers.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

namespace fidservo::gap {
namespace {

/// Whether another effect explains better in place of the one at an index. If it is that one's simpler form
/// it does so unless the richer effect's gain is real.
bool replaces(const Search& search, const Trial& other, const Chain& chain, std::size_t at) {
    if (is_limit_of(*other.candidate->effect, *chain.choices[at].candidate->effect))
        return !search.is_real(other.fitted, chain.fitted);
    return other.fitted.loss < chain.fitted.loss - least_gain;
}

/// The rest of a chain without one effect, with an effect that is new to the chain instead, and without a
/// second one of the chain's: returned if it explains as well as the chain, since the two may have been
/// accepted in place of the new one.
std::optional<Chain> shorter_with_another(const Search& search, const Chain& chain, const Chain& rest,
                                          const std::vector<Trial>& trials) {
    constexpr double as_good = 0.75;  // share of the gain, before the other effect is fitted closely
    if (rest.choices.size() < 2) return {};
    for (const Trial& trial : trials) {
        const bool is_known =
            std::ranges::find(chain.choices, trial.candidate, &Choice::candidate) != chain.choices.end();
        if (!trial.is_leader || is_known || trial.gain < as_good * (rest.fitted.loss - chain.fitted.loss))
            continue;
        const Chain other = grown(search, rest, {trial});
        for (std::size_t k = 0; k < rest.choices.size(); ++k) {
            Chain shorter = without(search, other, k);
            if (search.is_real(shorter.fitted, other.fitted)) continue;
            shorter.fitted = search.closer(search.nothing(), std::move(shorter.fitted), *trial.candidate);
            if (!search.is_real(shorter.fitted, chain.fitted)) return shorter;
        }
    }
    return {};
}

/// Whether an error of any signal that an effect changes is above its floor.
bool leaves_a_gap(const Evidence& evidence, const CrossFit& fitted, const plant::EffectSetting& effect) {
    const SignalFlags reached = reached_by({effect});
    return std::ranges::any_of(
        signal_gaps(evidence, fitted.mean_squares, fitted.mean_squares),
        [&](const SignalGap& signal) { return reached[index_of(signal.signal)] && is_left(signal); });
}

}  // namespace

bool exchange(Search& search, Chain& chain, bool changed) {
    int exchanges = 0;
    const auto tested = [&] { return changed ? chain.choices.size() : chain.choices.size() - 1; };
    std::size_t k = 0;
    const auto start_over_with = [&](Chain other) {
        chain = std::move(other);
        changed = true;
        k = 0;
    };
    while (chain.choices.size() > 1 && k < tested()) {
        Chain rest = without(search, chain, k);
        if (!search.is_real(rest.fitted, chain.fitted)) {
            start_over_with(std::move(rest));
            continue;
        }
        if (search.leaves_little(chain.fitted))
            search.remember(rest.fitted, *chain.choices[k].candidate, chain.fitted, k);
        std::vector<Trial> trials = search.try_all(rest.fitted, rest.candidates());
        if (std::optional<Chain> shorter = shorter_with_another(search, chain, rest, trials)) {
            start_over_with(*std::move(shorter));
            continue;
        }
        const bool is_other = has_leader(trials) && trials.front().candidate != chain.choices[k].candidate;
        if (!is_other) {
            // The same effect again: its alternatives are now those beside the whole rest.
            if (has_leader(trials)) chain.choices[k] = choice_of(search, rest.fitted, std::move(trials));
            ++k;
        } else if (replaces(search, trials.front(), chain, k) && exchanges++ < most_rounds) {
            start_over_with(grown(search, std::move(rest), std::move(trials)));
        } else {
            ++k;
        }
    }
    return changed;
}

Chain without_needless(const Search& search, const Evidence& evidence, Chain chain) {
    constexpr std::size_t most_tested = narrow_beam;
    while (chain.choices.size() > 1) {
        const Hypothesis& settings = chain.fitted.of_half[0];
        std::vector<std::pair<double, std::size_t>> order;  // by the loss without them
        for (std::size_t k = 0; k < settings.size(); ++k)
            if (!leaves_a_gap(evidence, chain.fitted, settings[k]))
                order.emplace_back(without_refit(search, chain, k).loss, k);
        std::ranges::sort(order);
        if (order.size() > most_tested) order.resize(most_tested);
        std::optional<Chain> shorter;
        for (const auto& [loss, k] : order) {
            Chain rest = without(search, chain, k);
            if (leaves_a_gap(evidence, rest.fitted, settings[k])) continue;
            shorter = std::move(rest);
            break;
        }
        if (!shorter) break;
        chain = *std::move(shorter);
    }
    return chain;
}

Chain without_hindrances(const Search& search, Chain chain) {
    if (is_long(chain)) {
        for (std::size_t k = 0; k < chain.choices.size(); ++k)
            chain.choices[k].left_out = without_refit(search, chain, k);
        return chain;
    }
    while (chain.choices.size() > 1) {
        std::vector<Chain> rests;
        rests.reserve(chain.choices.size());
        for (std::size_t k = 0; k < chain.choices.size(); ++k) rests.push_back(without(search, chain, k));
        const auto loss_of = [](const Chain& rest) { return rest.fitted.loss; };
        const auto best = std::ranges::min_element(rests, {}, loss_of);
        if (best->fitted.loss > chain.fitted.loss) {
            for (std::size_t k = 0; k < rests.size(); ++k)
                chain.choices[k].left_out = std::move(rests[k].fitted);
            return chain;
        }
        chain = std::move(*best);
    }
    for (Choice& only : chain.choices) only.left_out = search.nothing();
    return chain;
}

}  // namespace fidservo::gap
