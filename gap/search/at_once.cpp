// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/search/at_once.h"

#include "gap/search/growth.h"
#include "gap/search/one_or_several.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

namespace fidservo::gap {
namespace {

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

/// Whether a signal is further off than all others, and far off.
bool is_largest_gap(const Search& search, const CrossFit& fitted, Signal signal) {
    return search.furthest_off(fitted) == signal && search.far_off(fitted)[index_of(signal)];
}

/// Whether the tags are to be explained after the carriage. The carriage's place at the time of a frame is
/// known to within a count only if its motion is predicted well; until then its error would be blamed on the
/// camera.
bool should_tags_wait(const Search& search, const Chain& chain) {
    return search.typical_floors(chain.fitted, Signal::encoder) > least_floors &&
           is_largest_gap(search, chain.fitted, Signal::encoder);
}

/// add_shapes_of() the Hall reading, which leaves half of the time to tags that are off as well, and then of
/// the tags. A Hall reading that is explained so far lets smooth effects of the tags show.
/// @param tags_wait  whether the tags have waited for the carriage to be explained
void add_shapes(Search& search, Chain& chain, bool tags_wait) {
    const bool are_tags_off = is_off(search, chain, Signal::tag) && !should_tags_wait(search, chain);
    const bool are_any = add_shapes_of(search, chain, Signal::hall, are_tags_off ? half_of_it : 1.0);
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

/// Whether a chain has an effect of the encoder's reading.
bool reads_otherwise(const Chain& chain) {
    return std::ranges::any_of(chain.choices, [](const Choice& choice) {
        return choice.candidate->effect->part == plant::Part::encoder;
    });
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
                                   std::vector<Trial>& alone) {
    if (!is_view_or_wire_off(search, chain)) return false;
    const Signal signal = is_off(search, chain, Signal::hall) ? Signal::hall : Signal::tag;
    add_shapes_beside(search, chain, all, tags_wait);
    const bool is_tried = is_off(search, chain, Signal::hall) && !hears_of_carriage(search, chain);
    if (all.choices.size() == chain.choices.size() && !is_tried) all = with_all_that_is_smooth(search, chain);
    return explain_by_one_or(search, chain, std::move(all), signal, alone);
}

/// Where no effects found at once explain the Hall reading, looks for effects one by one, and then again for
/// all smooth ones beside these. Effects of the wire are searched apart from those of the carriage; if both
/// signals are off, each search gets half of the effort, and this one no more than half of the time.
/// @param alone  receives the trials of the first step
/// @return whether several effects were accepted in one step
bool explain_hall(Search& search, Chain& chain, std::vector<Trial>& alone) {
    if (!is_off(search, chain, Signal::hall)) return false;
    bool are_several = false;
    const bool is_carriage_off = is_off(search, chain, Signal::encoder);
    search.look_for_causes_in(only(Signal::hall), is_carriage_off ? half_of_it : 1.0);
    try {
        const Budget::Share share(search.budget(), is_carriage_off ? half_of_it : 1.0);
        // What many causes of the wire promise is alike, and little where a resonance is between two points
        // of its grid.
        constexpr auto all = std::numeric_limits<std::size_t>::max();
        const Growth growth{.most_effects = chain.choices.size() + most_one_by_one, .fits = all};
        are_several = grow(search, chain, growth, &alone);
    } catch (const ShareEnded&) {
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
    const bool is_hall_first = is_largest_gap(search, aside.smooth->fitted, Signal::hall);
    bool are_several = is_hall_first && explain_hall(search, chain, alone);
    bool is_balanced = explain_carriage(search, chain, aside, alone);
    const bool was_read_otherwise = reads_otherwise(chain), do_tags_wait = should_tags_wait(search, chain);
    Chain smooth = joined(search, chain, *aside.smooth);
    aside.smooth.reset();
    const bool is_known =
        explain_view_and_wire_at_once(search, chain, std::move(smooth), tags_wait, alone) || are_many;
    are_several = are_several || is_known || is_balanced;
    if (!is_known && !is_hall_first) are_several = explain_hall(search, chain, alone) || are_several;
    if (reads_otherwise(chain) && !was_read_otherwise && is_off(search, chain, Signal::encoder)) {
        is_balanced = explain_carriage_again(search, chain, aside, alone);
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
