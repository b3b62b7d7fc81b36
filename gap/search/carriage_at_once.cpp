// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/search/carriage_at_once.h"

#include "gap/numbers.h"
#include "gap/search/exchange.h"
#include "gap/search/growth.h"
#include "gap/search/one_or_several.h"
#include "gap/starts/scatter.h"

#include <algorithm>
#include <utility>

namespace fidservo::gap {
namespace {

/// Explains the encoder by a model from the balance of the carriage's forces, in which effects simply add up.
/// If the model leaves the encoder off its floor, it is accepted for the time being.
/// @param aside  receives the chain with the model in that case
/// @return whether the model brings the encoder to its floor and was accepted
bool explain_carriage_at_once(Search& search, Chain& chain, Aside& aside, std::vector<Trial>& alone) {
    if (!is_off(search, chain, Signal::encoder)) return false;
    Chain whole = in_plain_forms(search, with_together(chain, search.forces_beside(chain.fitted)));
    if (!is_off(search, whole, Signal::encoder))
        return explain_by_one_or(search, chain, std::move(whole), Signal::encoder, alone);
    if (whole.choices.size() > chain.choices.size() && is_better(search, whole, chain)) {
        aside.is_by_forces_mostly =
            search.nearly_clears(chain.fitted, whole.fitted, nearly_all) &&
            std::ranges::all_of(whole.choices, [&](const Choice& choice) {
                return !moves_carriage(*choice.candidate->effect) || search.is_force(*choice.candidate);
            });
        aside.by_forces = chain = whole;
    }
    return false;
}

/// Where the encoder is further off than any other signal and no forces balance what the carriage does, looks
/// for one effect on it that is no force: play, a belt, or a late command. Beside it forces show that did not
/// before. A force that the balance does not show is left to a search for places and periods, unless the time
/// for the search is over.
/// @param aside  loses the model from the balance of forces if the one effect explains better
void explain_carriage_by_one(Search& search, Chain& chain, Aside& aside, std::vector<Trial>& alone) {
    if (search.furthest_off(chain.fitted) != Signal::encoder) return;
    Chain one = without_carriage(search, chain);
    search.look_for_causes_in(only(Signal::encoder), 1.0);
    std::vector<Trial> trials = search.try_all(one.fitted, one.candidates(), {.scatters = false});
    search.look_for_causes_in(all_signals, 1.0);
    add_tried(alone, trials);
    if (!has_leader(trials) || (search.is_force(*trials.front().candidate) && !search.over()) ||
        !search.is_real(one.fitted, trials.front().fitted))
        return;
    one = grown(search, std::move(one), std::move(trials));
    search.limit(true);
    if (!is_better(search, one, chain)) return;
    chain = std::move(one);
    aside.by_forces.reset();
    search.throw_if_over();
    if (!is_off(search, chain, Signal::encoder)) return;
    Chain whole = in_plain_forms(search, with_together(chain, search.forces_beside(chain.fitted)));
    if (is_better(search, whole, chain)) chain = std::move(whole);
}

/// Continues from a model of the balance of forces that leaves the encoder off its floor: adds what is best
/// beside it and tests each effect, with half of the effort and of the time.
/// @return whether the search for more is to start from there: the encoder has come to its floor, or next to
/// nothing is left and there was no time to try all
bool goes_on_to_the_floor(Search& search, Chain& chain) {
    constexpr std::size_t most_added = 2;
    const Growth growth{.most_effects = chain.choices.size() + most_added, .scans = false};
    bool is_cut_short = false;
    search.look_for_causes_in(only(Signal::encoder), half_of_it);
    search.limit(true);
    try {
        const Budget::Share share(search.budget(), half_of_it);
        const Candidate& last = *chain.choices.back().candidate;
        if (!is_long(chain) && moves_carriage(*last.effect) && !has_valleys(last)) {
            CrossFit closer = search.closer(search.nothing(), chain.fitted, last);
            if (closer.loss < chain.fitted.loss) chain.fitted = std::move(closer);
        }
        grow(search, chain, growth, nullptr);
        if (!is_long(chain)) exchange(search, chain, false);
    } catch (const ShareEnded&) {
        is_cut_short = true;
    } catch (const SearchExhausted&) {
        if (search.over()) throw;
    }
    search.limit(false);
    search.look_for_causes_in(all_signals, 1.0);
    return !is_off(search, chain, Signal::encoder) ||
           (is_cut_short && search.nearly_clears(without_carriage(search, chain).fitted, chain.fitted));
}

}  // namespace

bool explain_carriage(Search& search, Chain& chain, Aside& aside, std::vector<Trial>& alone) {
    bool is_balanced = explain_carriage_at_once(search, chain, aside, alone);
    if (!is_balanced && !aside.is_by_forces_mostly) explain_carriage_by_one(search, chain, aside, alone);
    if (!aside.by_forces || !aside.is_by_forces_mostly) return is_balanced;
    is_balanced = goes_on_to_the_floor(search, *aside.by_forces);
    chain = *aside.by_forces;
    if (is_balanced) aside.by_forces.reset();
    return is_balanced;
}

bool explain_carriage_again(Search& search, Chain& chain, Aside& aside, std::vector<Trial>& alone) {
    Chain afresh = without_carriage(search, chain);
    Aside again;
    const bool is_balanced = explain_carriage_at_once(search, afresh, again, alone);
    if (!is_better(search, afresh, chain)) return false;
    chain = std::move(afresh);
    aside = std::move(again);
    return is_balanced;
}

Chain without_carriage(const Search& search, const Chain& chain) {
    Chain rest;
    add_choices(rest, chain,
                [](const plant::Effect& effect) { return effect.part != plant::Part::carriage; });
    search.judge(rest.fitted);
    return rest;
}

Chain with_carriage_of(const Search& search, const Chain& chain, const Chain& other) {
    Chain merged;
    add_choices(merged, chain, [](const plant::Effect& effect) { return !moves_carriage(effect); });
    add_choices(merged, other, moves_carriage);
    search.judge(merged.fitted);
    return merged;
}

}  // namespace fidservo::gap
