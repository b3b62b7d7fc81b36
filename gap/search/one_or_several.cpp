// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/search/one_or_several.h"

#include "gap/numbers.h"
#include "gap/search/everything.h"
#include "gap/search/growth.h"

#include <algorithm>
#include <functional>
#include <utility>

namespace fidservo::gap {
namespace {

/// Whether `whole` has the effects of `chain`, followed by the first of the trials that were made beside it.
bool adds_the_first_of(const Chain& whole, const Chain& chain, const std::vector<Trial>& trials) {
    std::vector<const Candidate*> expected = chain.candidates();
    expected.push_back(trials.front().candidate);
    return whole.candidates() == expected;
}

}  // namespace

bool is_off(const Search& search, const Chain& chain, Signal signal) {
    return search.off(chain.fitted)[index_of(signal)];
}

Chain with_together(Chain chain, Search::Together together) {
    chain.fitted = std::move(together.fitted);
    for (std::size_t k = 0; k < together.candidates.size(); ++k) {
        const Candidate* const candidate = together.candidates[k];
        Trial itself{
            .candidate = candidate, .gain = together.worth[k], .is_leader = true, .fitted = chain.fitted};
        chain.choices.push_back(
            {candidate, chain.fitted.loss + together.worth[k], {std::move(itself)}, {}, {}});
    }
    return chain;
}

bool explain_by_one_or(Search& search, Chain& chain, Chain whole, Signal signal, std::vector<Trial>& alone) {
    if (whole.choices.size() <= chain.choices.size() || !is_better(search, whole, chain)) return false;
    const auto take_whole = [&] {
        chain = std::move(whole);
        return true;
    };
    if (whole.choices.size() > chain.choices.size() + most_one_by_one || is_long(whole)) return take_whole();
    const auto look_everywhere_again = [&] {
        search.limit(false);
        search.look_for_causes_in(all_signals, 1.0);
    };
    Chain one = chain;
    try {
        search.look_for_causes_in(only(signal), 1.0);
        std::vector<Trial> trials =
            search.try_all(chain.fitted, chain.candidates(),
                           {.scatters = false, .refines = false, .competitor = &whole.fitted});
        add_tried(alone, trials);
        const double gain = chain.fitted.loss - whole.fitted.loss;
        if (has_leader(trials) && is_smooth(*trials.front().candidate) &&
            adds_the_first_of(whole, chain, trials) && !is_off(search, whole, signal)) {
            trials.front().fitted = whole.fitted;
            trials.front().gain = gain;
            chain = grown(search, std::move(chain), std::move(trials));
            look_everywhere_again();
            return true;
        }
        if (has_leader(trials) && trials.front().gain > nearly_all * gain)
            grow(search, one, {.most_effects = chain.choices.size() + 1, .scans = false}, &alone);
        look_everywhere_again();
    } catch (...) {
        take_whole();
        throw;
    }
    if (one.choices.size() == chain.choices.size() || is_better(search, whole, one)) return take_whole();
    chain = std::move(one);
    return false;
}

void add_tried(std::vector<Trial>& alone, std::vector<Trial> later) {
    for (Trial& trial : later) {
        const auto known = std::ranges::find(alone, trial.candidate, &Trial::candidate);
        if (known == alone.end())
            alone.push_back(std::move(trial));
        else if (trial.gain > known->gain)
            *known = std::move(trial);
    }
    std::ranges::stable_sort(alone, std::greater{}, &Trial::gain);
}

}  // namespace fidservo::gap
