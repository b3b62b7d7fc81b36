// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/search/at_once.h"

#include "gap/search/everything.h"
#include "gap/search/exchange.h"
#include "gap/search/growth.h"
#include "gap/search/scatter.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <utility>

namespace fidservo::gap {
namespace {

/// A chain with the cross fit of `together`, whose candidates are appended as choices.
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

/// A chain with the cross fit of `together`. Effects of the chain that are in this fit stay; those that were
/// fitted anew are replaced by the candidates of `together`.
Chain with_everything(const Chain& chain, Search::Together together) {
    const auto stays = [&](const Choice& choice) {
        return has_effect(together.fitted.of_half[0], *choice.candidate->effect) &&
               std::ranges::find(together.candidates, choice.candidate) == together.candidates.end();
    };
    Chain rest;
    std::ranges::copy_if(chain.choices, std::back_inserter(rest.choices), stays);
    return with_together(std::move(rest), std::move(together));
}

/// A chain with all smooth effects that are needed in place of its own ones, if that makes it longer; else
/// the chain itself.
Chain with_all_that_is_smooth(Search& search, const Chain& chain) {
    Chain all = with_everything(chain, search.everything_beside(chain.fitted));
    return all.choices.size() > chain.choices.size() ? all : chain;
}

bool is_view_or_wire_off(const Search& search, const Chain& chain) {
    return is_off(search, chain, Signal::hall) || is_off(search, chain, Signal::tag);
}

/// Adds effects with shapes of their own to explain a signal that is off its floor, each time together with
/// all smooth effects that are then needed, as long as the longer chain is better.
/// @param chain  each change is an improvement, so that it may be used whenever this ends
/// @param share  of the time that is left, which this may take
/// @return whether any was added
bool add_shapes_of(Search& search, Chain& chain, Signal signal, double share = 1.0) {
    bool is_any = false;
    try {
        const Budget::Share part(search.budget(), share);
        while (is_off(search, chain, signal)) {
            Chain longer = with_everything(chain, search.shaped_beside(chain.fitted, signal));
            if (!is_better(search, longer, chain)) break;
            chain = std::move(longer);
            is_any = true;
            search.throw_if_over();
        }
    } catch (const ShareEnded&) {
    }
    return is_any;
}

/// Whether tags are better not explained before the carriage is: its place when a frame was taken is known
/// within a count only where its motion is predicted.
bool should_tags_wait(const Search& search, const Chain& chain) {
    return search.far_off(chain.fitted)[index_of(Signal::encoder)] &&
           search.furthest_off(chain.fitted) == Signal::encoder;
}

/// add_shapes_of() the Hall reading, which leaves half of the time to tags that are off as well, and then of
/// the tags. A Hall reading that is explained so far lets smooth effects of the tags show.
/// @param tags_wait  whether the tags have waited for the carriage to be explained
void add_shapes(Search& search, Chain& chain, bool tags_wait) {
    constexpr double half = 0.5;
    const bool are_tags_off = is_off(search, chain, Signal::tag) && !should_tags_wait(search, chain);
    const bool are_any = add_shapes_of(search, chain, Signal::hall, are_tags_off ? half : 1.0);
    if (should_tags_wait(search, chain)) return;
    if ((are_any || tags_wait) && is_off(search, chain, Signal::tag)) {
        Chain whole = with_everything(chain, search.tags_beside(chain.fitted));
        if (is_better(search, whole, chain)) chain = std::move(whole);
        search.throw_if_over();
    }
    add_shapes_of(search, chain, Signal::tag);
}

/// add_shapes() to another chain. If the search ends meanwhile, the one with the smaller loss is kept as
/// `chain`.
void add_shapes_beside(Search& search, Chain& chain, Chain& other, bool tags_wait) {
    try {
        search.throw_if_over();
        add_shapes(search, other, tags_wait);
    } catch (...) {
        if (other.fitted.loss < chain.fitted.loss) chain = std::move(other);
        throw;
    }
}

/// Appends those choices of a chain, with their settings, whose effects satisfy `wants`.
template <class Wants>
void add_choices(Chain& to, const Chain& from, const Wants& wants) {
    for (std::size_t k = 0; k < from.choices.size(); ++k) {
        if (!wants(*from.choices[k].candidate->effect)) continue;
        to.choices.push_back(from.choices[k]);
        for (std::size_t side = 0; side < 2; ++side)
            to.fitted.of_half[side].push_back(from.fitted.of_half[side][k]);
    }
}

/// A chain without effects on the carriage's motion. Effects on its reading stay, since tags show them, too.
Chain without_carriage(const Search& search, const Chain& chain) {
    Chain rest;
    add_choices(rest, chain,
                [](const plant::Effect& effect) { return effect.part != plant::Part::carriage; });
    search.judge(rest.fitted);
    return rest;
}

/// Whether a chain has an effect of the encoder's reading.
bool reads_otherwise(const Chain& chain) {
    return std::ranges::any_of(chain.choices, [](const Choice& choice) {
        return choice.candidate->effect->part == plant::Part::encoder;
    });
}

/// Explanations of a signal by more effects than this, found at once, are accepted without a search.
constexpr std::size_t most_one_by_one = 2;

/// Whether `whole` has the effects of `chain`, followed by the first of the trials that were made beside it.
bool adds_the_first_of(const Chain& whole, const Chain& chain, const std::vector<Trial>& trials) {
    std::vector<const Candidate*> expected = chain.candidates();
    expected.push_back(trials.front().candidate);
    return whole.candidates() == expected;
}

/// Explains a signal that is off its floor by one effect, or by those that `whole` found at once if these do
/// better. More than two such effects, or such as make the chain long, are not compared with a single one. A
/// smooth effect that both ways find, and that brings the signal to its floor, is not fitted more closely.
/// @return whether the effects of `whole` were accepted
bool explain_by_one_or(Search& search, Chain& chain, Chain whole, Signal signal, std::vector<Trial>* alone) {
    constexpr double nearly = 0.9;  // share of the gain of `whole`
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

/// Several small causes in wire, sensors and view are much more common than a single one that does the same:
/// if more are needed together than could be found one by one, and nothing far off is left of the Hall
/// reading, which would be of another kind, they are accepted.
/// @param all  the chain with all smooth effects
/// @return whether they were accepted
bool explain_by_many(const Search& search, Chain& chain, const Chain& all) {
    if (all.choices.size() <= chain.choices.size() + most_one_by_one || !is_better(search, all, chain) ||
        search.far_off(all.fitted)[index_of(Signal::hall)])
        return false;
    chain = all;
    return true;
}

/// Whether the carriage's motion, as far as a chain explains it, shows in the Hall reading.
bool hears_of_carriage(const Search& search, const Chain& chain) {
    return std::ranges::any_of(chain.choices, [&](const Choice& choice) {
        return moves_carriage(*choice.candidate->effect) &&
               search.concerned_by(*choice.candidate, chain.fitted)[index_of(Signal::hall)];
    });
}

/// Explains Hall reading and tags. Their causes can stand in for each other, so that all are looked at
/// together.
/// @param all  the chain, or the chain with all smooth effects
/// @param tags_wait  whether the tags have waited for the carriage to be explained
/// @return whether effects found at once were accepted
bool explain_view_and_wire_at_once(Search& search, Chain& chain, Chain all, bool tags_wait,
                                   std::vector<Trial>* alone) {
    if (!is_view_or_wire_off(search, chain)) return false;
    const Signal signal = is_off(search, chain, Signal::hall) ? Signal::hall : Signal::tag;
    add_shapes_beside(search, chain, all, tags_wait);
    const bool is_tried = is_off(search, chain, Signal::hall) && !hears_of_carriage(search, chain);
    if (all.choices.size() == chain.choices.size() && !is_tried) all = with_all_that_is_smooth(search, chain);
    return explain_by_one_or(search, chain, std::move(all), signal, alone);
}

/// Explains the encoder by a model from the balance of the carriage's forces, in which effects simply add up.
/// If the model leaves the encoder off its floor, it is accepted for the time being.
/// @param aside  receives the chain with the model in that case
/// @return whether the model brings the encoder to its floor and was accepted
bool explain_carriage_at_once(Search& search, Chain& chain, Aside& aside, std::vector<Trial>* alone) {
    constexpr double most_of_it = 0.9;
    if (!is_off(search, chain, Signal::encoder)) return false;
    Chain whole = in_plain_forms(search, with_together(chain, search.forces_beside(chain.fitted)));
    if (!is_off(search, whole, Signal::encoder))
        return explain_by_one_or(search, chain, std::move(whole), Signal::encoder, alone);
    if (whole.choices.size() > chain.choices.size() && is_better(search, whole, chain)) {
        aside.is_by_forces_mostly =
            search.nearly_clears(chain.fitted, whole.fitted, most_of_it) &&
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
/// @return whether the encoder comes to its floor
bool goes_on_to_the_floor(Search& search, Chain& chain) {
    constexpr double half = 0.5;
    constexpr std::size_t most_added = 2;
    const Growth growth{.most_effects = chain.choices.size() + most_added, .scans = false};
    search.look_for_causes_in(only(Signal::encoder), half);
    search.limit(true);
    try {
        const Budget::Share share(search.budget(), half);
        const Candidate& last = *chain.choices.back().candidate;
        if (!is_long(chain) && moves_carriage(*last.effect) && !has_valleys(last)) {
            CrossFit closer = search.closer(search.nothing(), chain.fitted, last);
            if (closer.loss < chain.fitted.loss) chain.fitted = std::move(closer);
        }
        grow(search, chain, growth, nullptr);
        if (!is_long(chain)) exchange(search, chain, false);
    } catch (const ShareEnded&) {
    } catch (const SearchExhausted&) {
        if (search.over()) throw;
    }
    search.limit(false);
    search.look_for_causes_in(all_signals, 1.0);
    return !is_off(search, chain, Signal::encoder);
}

/// explain_carriage_at_once() where an effect of the encoder's reading has been found since: it makes the
/// motion known better, and with it the forces.
bool explain_carriage_again(Search& search, Chain& chain, Aside& aside, std::vector<Trial>* alone) {
    Chain afresh = without_carriage(search, chain);
    Aside again;
    const bool is_balanced = explain_carriage_at_once(search, afresh, again, alone);
    if (!is_better(search, afresh, chain)) return false;
    chain = std::move(afresh);
    aside = std::move(again);
    return is_balanced;
}

/// Where no effects found at once explain the Hall reading, looks for effects one by one, and then again for
/// all smooth ones beside these. Effects of the wire are searched apart from those of the carriage; if both
/// signals are off, each search gets half of the effort.
/// @param alone  receives the trials of the first step
/// @return whether several effects were accepted in one step
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
    add_shapes_beside(search, chain, whole, false);
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

Chain joined(const Search& search, const Chain& chain, const Chain& other) {
    const auto is_lacking = [&](const plant::Effect& effect) {
        return std::ranges::none_of(
            chain.choices, [&](const Choice& choice) { return choice.candidate->effect == &effect; });
    };
    Chain both = chain;
    add_choices(both, other, is_lacking);
    if (both.choices.size() > chain.choices.size())
        search.fit_again(both.fitted, either(only(Signal::hall), only(Signal::tag)));
    return both;
}

AtOnce explain_at_once(Search& search, Chain& chain, Aside& aside, std::vector<Trial>& alone) {
    const bool tags_wait = is_off(search, chain, Signal::encoder);
    aside.smooth = is_view_or_wire_off(search, chain) ? with_all_that_is_smooth(search, chain) : chain;
    const bool are_many = explain_by_many(search, chain, *aside.smooth);
    search.throw_if_over();
    bool is_balanced = explain_carriage_at_once(search, chain, aside, &alone);
    if (!is_balanced && !aside.is_by_forces_mostly) explain_carriage_by_one(search, chain, aside, alone);
    if (aside.by_forces && aside.is_by_forces_mostly) {
        is_balanced = goes_on_to_the_floor(search, *aside.by_forces);
        chain = *aside.by_forces;
        if (is_balanced) aside.by_forces.reset();
    }
    const bool was_read_otherwise = reads_otherwise(chain), do_tags_wait = should_tags_wait(search, chain);
    Chain smooth = joined(search, chain, *aside.smooth);
    aside.smooth.reset();
    const bool is_known =
        explain_view_and_wire_at_once(search, chain, std::move(smooth), tags_wait, &alone) || are_many;
    bool are_several = is_known || is_balanced;
    if (!is_known) are_several = explain_hall(search, chain, &alone) || are_several;
    if (reads_otherwise(chain) && !was_read_otherwise && is_off(search, chain, Signal::encoder)) {
        is_balanced = explain_carriage_again(search, chain, aside, &alone);
        are_several = are_several || is_balanced;
    }
    if (aside.by_forces) {
        aside.by_forces = chain;
        chain = without_carriage(search, chain);
    }
    return {is_balanced, are_several, do_tags_wait};
}

void explain_waiting_tags(Search& search, Chain& chain) {
    if (should_tags_wait(search, chain)) return;
    Chain whole = chain;
    add_shapes_beside(search, chain, whole, true);
    if (is_better(search, whole, chain)) chain = std::move(whole);
}

}  // namespace fidservo::gap
