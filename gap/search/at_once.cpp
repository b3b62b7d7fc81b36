// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/search/at_once.h"

#include "gap/search/everything.h"
#include "gap/search/growth.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <utility>

namespace fidservo::gap {
namespace {

/// A chain, explained so far as `together` has it, with what was needed there as its last choices.
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

bool is_off(const Search& search, const Chain& chain, Signal signal) {
    return search.off(chain.fitted)[index_of(signal)];
}

/// A chain with what was found of everything in place of those of its effects that were fitted again.
Chain with_everything(const Chain& chain, Search::Together together) {
    const auto stays = [&](const Choice& choice) {
        const Hypothesis& found = together.fitted.of_half[0];
        return std::ranges::find(found, choice.candidate->effect, &plant::EffectSetting::effect) !=
                   found.end() &&
               std::ranges::find(together.candidates, choice.candidate) == together.candidates.end();
    };
    Chain rest;
    std::ranges::copy_if(chain.choices, std::back_inserter(rest.choices), stays);
    return with_together(std::move(rest), std::move(together));
}

/// A chain with what is needed of everything in place of its smooth effects, if that is more than it has.
Chain with_all_that_is_smooth(const Search& search, const Chain& chain) {
    Chain all = with_everything(chain, search.everything_beside(chain.fitted));
    return all.choices.size() > chain.choices.size() ? all : chain;
}

bool is_view_or_wire_off(const Search& search, const Chain& chain) {
    return is_off(search, chain, Signal::hall) || is_off(search, chain, Signal::tag);
}

/// A chain with further effects that have a shape of their own, one after the other and each time with all
/// that is smooth, as long as Hall reading or tags stay off their floors and each is no chance.
/// @param chain  is better each time that it is changed
void add_shapes(const Search& search, Chain& chain) {
    while (is_view_or_wire_off(search, chain)) {
        std::optional<Chain> best;
        for (Search::Together& together : search.shaped_beside(chain.fitted)) {
            Chain longer = with_everything(chain, std::move(together));
            if (!best || longer.fitted.loss < best->fitted.loss) best = std::move(longer);
        }
        if (!best || !is_better(search, *best, chain)) return;
        chain = *std::move(best);
    }
}

/// Adds those choices of a chain, with their settings, whose effects are wanted.
template <class Wants>
void add_choices(Chain& to, const Chain& from, const Wants& wants) {
    for (std::size_t k = 0; k < from.choices.size(); ++k) {
        if (!wants(*from.choices[k].candidate->effect)) continue;
        to.choices.push_back(from.choices[k]);
        for (std::size_t side = 0; side < 2; ++side)
            to.fitted.of_half[side].push_back(from.fitted.of_half[side][k]);
    }
}

/// A chain with nothing of how the carriage moves. How it is read, tags tell as well.
Chain without_carriage(const Search& search, const Chain& chain) {
    Chain rest;
    add_choices(rest, chain,
                [](const plant::Effect& effect) { return effect.part != plant::Part::carriage; });
    search.judge(rest.fitted);
    return rest;
}

/// What explains a signal at once, of more effects than this, needs no search.
constexpr std::size_t most_one_by_one = 2;

/// Whether a whole chain is another one with the first of those that were tried beside it.
bool adds_the_first_of(const Chain& whole, const Chain& chain, const std::vector<Trial>& trials) {
    std::vector<const Candidate*> expected = chain.candidates();
    expected.push_back(trials.front().candidate);
    return whole.candidates() == expected;
}

/// A signal that is off its floor is explained by one effect, or by those that a whole chain has found at
/// once where these do better. Many that were needed together need no comparison; a smooth effect that both
/// ways come to, and that leaves nothing, no closer fit.
/// @return whether the whole stands
bool explain_by_one_or(Search& search, Chain& chain, Chain whole, Signal signal, std::vector<Trial>* alone) {
    constexpr double nearly = 0.9;  // of what the whole gains
    if (whole.choices.size() <= chain.choices.size() || !is_better(search, whole, chain)) return false;
    const auto take_whole = [&] {
        chain = std::move(whole);
        return true;
    };
    if (whole.choices.size() > chain.choices.size() + most_one_by_one) return take_whole();
    const auto look_everywhere_again = [&] {
        search.limit(false);
        search.look_for_causes_in(all_signals, 1.0);
    };
    Chain one = chain;
    try {
        search.look_for_causes_in(only(signal), 1.0);
        std::vector<Trial> trials =
            search.try_all(chain.fitted, chain.candidates(), {.scatters = false, .refines = false});
        add_tried(*alone, trials);
        const double gain = chain.fitted.loss - whole.fitted.loss;
        if (has_leader(trials) && is_smooth(*trials.front().candidate) &&
            adds_the_first_of(whole, chain, trials) && !is_off(search, whole, signal)) {
            trials.front().fitted = whole.fitted;
            trials.front().gain = gain;
            chain = grown(search, std::move(chain), std::move(trials));
            look_everywhere_again();
            return true;
        }
        if (has_leader(trials) && trials.front().gain > nearly * gain)
            grow(search, one, {.most_effects = chain.choices.size() + 1, .scans = false}, alone);
        look_everywhere_again();
    } catch (...) {
        take_whole();
        throw;
    }
    if (one.choices.size() == chain.choices.size() || is_better(search, whole, one)) return take_whole();
    chain = std::move(one);
    return false;
}

/// Small causes of wire, sensors and view are many more often than one that does what they do: where more are
/// needed together than could be found one by one, they stand.
/// @param all  the chain with all that is smooth
/// @return whether they do
bool explain_by_many(const Search& search, Chain& chain, const Chain& all) {
    if (all.choices.size() <= chain.choices.size() + most_one_by_one || !is_better(search, all, chain))
        return false;
    chain = all;
    return true;
}

/// What moves the wire, or what is seen, has causes that stand in for each other: all of them are looked at
/// together.
/// @param all  the chain with all that is smooth
bool explain_view_and_wire_at_once(Search& search, Chain& chain, Chain all, std::vector<Trial>* alone) {
    if (!is_view_or_wire_off(search, chain)) return false;
    const Signal signal = is_off(search, chain, Signal::hall) ? Signal::hall : Signal::tag;
    try {
        add_shapes(search, all);
    } catch (const BudgetEnded&) {
        chain = std::move(all);
        throw;
    }
    return explain_by_one_or(search, chain, std::move(all), signal, alone);
}

/// What moves the carriage adds up in the balance of its forces. What balances them and leaves the encoder
/// off its floor stands for the time being.
/// @param aside  that, where it does
/// @return whether what balances them brings the encoder to its floor
bool explain_carriage_at_once(Search& search, Chain& chain, std::optional<Chain>& aside,
                              std::vector<Trial>* alone) {
    if (!is_off(search, chain, Signal::encoder)) return false;
    Chain whole = with_together(chain, search.forces_beside(chain.fitted));
    if (!is_off(search, whole, Signal::encoder))
        return explain_by_one_or(search, chain, std::move(whole), Signal::encoder, alone);
    if (whole.choices.size() > chain.choices.size() && is_better(search, whole, chain))
        aside = chain = std::move(whole);
    return false;
}

/// Where many do not explain the Hall reading at once, they are looked for one by one, and once more together
/// with what that has found. The wire is searched apart from the carriage; where both are off, each has its
/// share of the effort.
/// @param alone  what was tried first
/// @return whether several were taken in at a time
bool explain_hall(Search& search, Chain& chain, std::vector<Trial>* alone) {
    constexpr double equal_share = 0.5;
    if (!is_off(search, chain, Signal::hall)) return false;
    bool are_several = false;
    const bool is_carriage_off = is_off(search, chain, Signal::encoder);
    search.look_for_causes_in(only(Signal::hall), is_carriage_off ? equal_share : 1.0);
    try {
        are_several = grow(search, chain, {.most_effects = chain.choices.size() + most_one_by_one}, alone);
    } catch (const SearchExhausted&) {
        if (search.over()) throw;
    }
    search.limit(false);
    search.look_for_causes_in(all_signals, 1.0);
    if (!is_off(search, chain, Signal::hall)) return are_several;
    Chain whole = with_all_that_is_smooth(search, chain);
    add_shapes(search, whole);
    if (is_better(search, whole, chain)) chain = std::move(whole);
    return are_several;
}

}  // namespace

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

Chain with_carriage_of(const Search& search, const Chain& chain, const Chain& other) {
    Chain merged;
    add_choices(merged, chain, [](const plant::Effect& effect) { return !moves_carriage(effect); });
    add_choices(merged, other, moves_carriage);
    search.judge(merged.fitted);
    return merged;
}

AtOnce explain_at_once(Search& search, Chain& chain, std::optional<Chain>& aside, std::vector<Trial>& alone) {
    Chain smooth = is_view_or_wire_off(search, chain) ? with_all_that_is_smooth(search, chain) : chain;
    const bool are_many = explain_by_many(search, chain, smooth);
    const bool is_balanced = explain_carriage_at_once(search, chain, aside, &alone);
    if (are_many)
        smooth = chain;
    else if (is_balanced || aside)
        smooth = with_all_that_is_smooth(search, chain);
    const bool is_known = explain_view_and_wire_at_once(search, chain, std::move(smooth), &alone) || are_many;
    bool are_several = is_known || is_balanced;
    if (!is_known) are_several = explain_hall(search, chain, &alone) || are_several;
    if (aside) {
        aside = chain;
        chain = without_carriage(search, chain);
    }
    return {is_balanced, are_several};
}

}  // namespace fidservo::gap
