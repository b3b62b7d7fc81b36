#include "gap/selection.h"

#include "gap/everything.h"
#include "gap/growth.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <utility>

namespace fidservo::gap {
namespace {

/// Whether another effect explains better in the place of one: a plainer form of it unless the richer one's
/// gain is no chance.
bool replaces(const Search& search, const Trial& other, const Chain& chain, std::size_t at) {
    if (is_limit_of(other.candidate->effect->name, chain.choices[at].candidate->effect->name))
        return !search.is_real(other.fitted, chain.fitted);
    return other.fitted.loss < chain.fitted.loss - least_gain;
}

/// The rest with another effect than the chain has, where that does as well without one of the rest: two that
/// were taken in for one.
std::optional<Chain> shorter_with_another(const Search& search, const Chain& chain, const Chain& rest,
                                          const std::vector<Trial>& trials) {
    constexpr double as_good = 0.75;  // of the gain, before the other one is fitted closer
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

/// An effect that was taken in first may have been a compromise of two others: each is given up where the
/// rest does as well without it, and otherwise exchanged for what is best beside the rest. As long as nothing
/// has changed the last one needs no test: it was found beside this very rest.
/// @param changed  whether anything changed before
/// @return whether anything changed, before or here
bool exchange(Search& search, Chain& chain, bool changed) {
    constexpr int most_exchanges = 4;
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
            // The same again, with its alternatives as they are beside the whole rest.
            if (has_leader(trials)) chain.choices[k] = choice_of(search, rest.fitted, std::move(trials));
            ++k;
        } else if (replaces(search, trials.front(), chain, k) && exchanges++ < most_exchanges) {
            start_over_with(grown(search, std::move(rest), std::move(trials)));
        } else {
            ++k;
        }
    }
    return changed;
}

/// Whether a pair explains what nothing was taken in for: two wrong effects fit most things a little, and by
/// little more than chance.
bool explains(const Search& search, const CrossFit& without, const CrossFit& with) {
    constexpr double most = 0.9, times_chance = 2.0;
    return search.nearly_clears(without, with) ||
           (search.nearly_clears(without, with, most) && search.is_no_chance(without, with, times_chance));
}

/// Where signals stay off their floors, what was taken in for them, one after the other, may be no step on
/// the way to what there is: instead of it each of the best single effects, with what is best beside it.
/// Where nothing was taken in, two effects may hide each other: what promises a little is tried as the first
/// of a pair.
/// @return whether anything changed
bool pair_up(Search& search, Chain& chain, std::size_t most_effects) {
    constexpr Effort effort{.fits = 3, .leaders = 1};
    const SignalFlags off = search.off(chain.fitted);
    if (off == SignalFlags{}) return false;
    constexpr double all_but_nothing = 0.999;
    const Chain rest = rest_of(search, chain, off);
    if (!has_room_for_two(rest, most_effects)) return false;
    const bool from_nothing = chain.choices.size() == rest.choices.size();
    bool changed = false;
    const auto leaves_nothing_after = [&](bool has_changed) {
        changed = changed || has_changed;
        return has_changed && search.is_at_floor(chain.fitted);
    };
    const auto take_in = [&](std::optional<Pair> pair) {
        return take_in_pair(search, chain, rest, std::move(pair), all_but_nothing, false);
    };
    if (leaves_nothing_after(take_in(search.encoder_pair(rest.fitted, rest.candidates())))) return true;
    if (leaves_nothing_after(balance(search, chain, most_effects, false))) return true;
    if (leaves_nothing_after(take_in(search.best_pair(rest.fitted, rest.candidates())))) return true;
    const std::size_t most_first = from_nothing ? 6 : 3;
    std::vector<Trial> singles = search.try_all(rest.fitted, rest.candidates(), {.scatters = false});
    if (!from_nothing && has_leader(singles)) {
        Chain one = grown(search, rest, singles);
        const bool is_closer = is_better(search, one, chain);
        if (is_closer) chain = std::move(one);
        if (leaves_nothing_after(is_closer)) return true;
    }
    if (from_nothing) std::ranges::stable_sort(singles, std::greater{}, &Trial::promised);
    std::vector<std::string> classes;
    for (const Trial& single : singles) {
        const bool is_new = std::ranges::find(classes, single.candidate->class_name) == classes.end();
        const bool is_hopeless = from_nothing ? single.promised <= 0.0 : single.gain < least_gain;
        if (is_hopeless || !is_new) continue;
        if (classes.size() == most_first) break;
        classes.push_back(single.candidate->class_name);
        std::optional<CrossFit> fitted = search.with(rest.fitted, *single.candidate);
        if (!fitted) continue;
        Trial first = single;
        first.is_leader = true;
        first.fitted = *std::move(fitted);
        const Chain one = grown(search, rest, {std::move(first)});
        std::vector<Trial> trials = search.try_all(one.fitted, one.candidates(), effort);
        if (!has_leader(trials)) continue;
        Chain two = grown(search, one, std::move(trials));
        if (!is_better(search, two, chain) || (from_nothing && !explains(search, chain.fitted, two.fitted)))
            continue;
        chain = std::move(two);
        changed = true;
        if (search.is_at_floor(chain.fitted)) break;
    }
    return changed;
}

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

/// A chain with what was found of everything in place of its smooth effects.
Chain with_everything(const Chain& chain, Search::Together together) {
    Chain rest;
    for (const Choice& choice : chain.choices)
        if (!is_smooth(*choice.candidate)) rest.choices.push_back(choice);
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

/// Whether fits without each of a chain's effects take too long.
bool is_long(const Chain& chain) {
    constexpr std::size_t most_short = 4;
    return chain.choices.size() > most_short;
}

/// What explains a signal at once, of more effects than this, needs no search.
constexpr std::size_t most_one_by_one = 2;

/// Adds what was tried later for signals of which nothing was tried before.
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
            grow(search, one, {.most_effects = chain.choices.size() + 1, .in_pairs = false}, alone);
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

/// What moves the wire has causes that stand in for each other: all of them are looked at together.
/// @param all  the chain with all that is smooth
bool explain_hall_at_once(Search& search, Chain& chain, Chain all, std::vector<Trial>* alone) {
    if (!is_off(search, chain, Signal::hall)) return false;
    try {
        add_shapes(search, all);
    } catch (const BudgetEnded&) {
        chain = std::move(all);
        throw;
    }
    return explain_by_one_or(search, chain, std::move(all), Signal::hall, alone);
}

/// A chain with what another one has of the carriage instead of its own.
Chain with_carriage_of(const Search& search, const Chain& chain, const Chain& other) {
    Chain merged;
    const auto add = [&](const Chain& from, bool of_carriage) {
        for (std::size_t k = 0; k < from.choices.size(); ++k) {
            if (moves_carriage(*from.choices[k].candidate->effect) != of_carriage) continue;
            merged.choices.push_back(from.choices[k]);
            for (std::size_t side = 0; side < 2; ++side)
                merged.fitted.of_half[side].push_back(from.fitted.of_half[side][k]);
        }
    };
    add(chain, false);
    add(other, true);
    search.judge(merged.fitted);
    return merged;
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
/// @return whether a pair took the place of something
bool explain_hall(Search& search, Chain& chain, std::vector<Trial>* alone) {
    constexpr double equal_share = 0.5;
    if (!is_off(search, chain, Signal::hall)) return false;
    bool is_paired = false;
    const bool is_carriage_off = is_off(search, chain, Signal::encoder);
    search.look_for_causes_in(only(Signal::hall), is_carriage_off ? equal_share : 1.0);
    try {
        is_paired = grow(search, chain, {.most_effects = chain.choices.size() + most_one_by_one}, alone);
    } catch (const SearchExhausted&) {
        if (search.over()) throw;
    }
    search.limit(false);
    search.look_for_causes_in(all_signals, 1.0);
    if (!is_off(search, chain, Signal::hall)) return is_paired;
    Chain whole = with_all_that_is_smooth(search, chain);
    add_shapes(search, whole);
    if (is_better(search, whole, chain)) chain = std::move(whole);
    return is_paired;
}

std::vector<const Candidate*> limits_in(const Chain& chain) {
    std::vector<const Candidate*> limits;
    for (const Choice& choice : chain.choices)
        if (choice.candidate->is_limit) limits.push_back(choice.candidate);
    return limits;
}

/// The chain without what cannot be named.
Chain nameable(const Search& search, Chain chain) {
    for (std::size_t k = chain.choices.size(); k-- > 0;)
        if (chain.choices[k].candidate->is_limit) chain = without(search, chain, k);
    return chain;
}

/// What is left without one of a chain's effects; of many, without another fit of the rest.
CrossFit left_out_of(const Search& search, const Chain& chain, std::size_t left_out) {
    if (chain.choices.size() == 1) return search.nothing();
    if (!is_long(chain)) return without(search, chain, left_out).fitted;
    CrossFit rest = chain.fitted;
    for (Hypothesis& hypothesis : rest.of_half)
        hypothesis.erase(hypothesis.begin() + static_cast<std::ptrdiff_t>(left_out));
    search.judge(rest);
    return rest;
}

/// Puts that first which alone would make the largest gap.
void put_largest_first(const Search& search, Chain& chain) {
    const std::size_t count = chain.choices.size();
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t k = 0; k < count; ++k) {
        chain.choices[k].gap_alone = search.gap_alone(chain.fitted.of_half[0][k]);
        order.emplace_back(chain.choices[k].gap_alone, k);
    }
    std::ranges::stable_sort(order, std::greater{}, &std::pair<double, std::size_t>::first);
    const auto in_order = [&](auto& values) {
        auto sorted = values;
        for (std::size_t k = 0; k < count; ++k) sorted[k] = std::move(values[order[k].second]);
        values = std::move(sorted);
    };
    in_order(chain.choices);
    for (Hypothesis& hypothesis : chain.fitted.of_half) in_order(hypothesis);
}

/// The first `count` effects of a chain alone.
CrossFit first_of(const Search& search, const Chain& chain, std::size_t count) {
    CrossFit fitted = chain.fitted;
    SignalFlags concerned{};
    for (std::size_t k = count; k < chain.choices.size(); ++k)
        concerned = either(concerned, search.concerned_by(*chain.choices[k].candidate, chain.fitted));
    for (Hypothesis& hypothesis : fitted.of_half) hypothesis.resize(count);
    if (is_long(chain))
        search.judge(fitted);
    else
        search.fit_again(fitted, concerned);
    return fitted;
}

}  // namespace

Fit fit_to_all(const Evidence& evidence, const CrossFit& cross) {
    constexpr int most_iterations = 6;  // from what fits half of it
    const Wanted wanted = everything(evidence);
    const Predict predict = [&](const Hypothesis& hypothesis) { return evidence.errors(hypothesis, wanted); };
    return fit(predict, evidence.windows(), wanted, cross.of_half[0],
               {.most_iterations = most_iterations, .tolerance = 1e-6, .with_covariance = true});
}

Selection select(const Evidence& evidence, const std::vector<Candidate>& candidates,
                 const SelectionOptions& options) {
    Search search(evidence, candidates, options.search);
    Selection selection;
    Chain chain{{}, search.nothing()};
    std::optional<Chain> by_forces;
    selection.steps.push_back(chain.fitted);
    try {
        Chain smooth = is_view_or_wire_off(search, chain) ? with_all_that_is_smooth(search, chain) : chain;
        const bool are_many = explain_by_many(search, chain, smooth);
        const bool is_balanced = explain_carriage_at_once(search, chain, by_forces, &selection.alone);
        if (are_many)
            smooth = chain;
        else if (is_balanced || by_forces)
            smooth = with_all_that_is_smooth(search, chain);
        const bool is_known =
            explain_hall_at_once(search, chain, std::move(smooth), &selection.alone) || are_many;
        bool is_paired = is_known || is_balanced;
        if (!is_known) is_paired = explain_hall(search, chain, &selection.alone) || is_paired;
        if (by_forces) {
            by_forces = chain;
            chain = with_carriage_of(search, chain, {});
        }
        const std::size_t most_effects = chain.choices.size() + options.most_effects;
        std::vector<Trial> tried;
        const Growth growth{.most_effects = most_effects, .in_pairs = !is_balanced};
        is_paired = grow(search, chain, growth, &tried) || is_paired;
        add_tried(selection.alone, std::move(tried));
        search.limit(true);
        if (!is_paired || !search.leaves_little(chain.fitted))
            is_paired = pair_up(search, chain, most_effects) || is_paired;
        // Of many, each was asked whether it is needed when they were fitted together.
        if (!is_long(chain) && exchange(search, chain, is_paired)) grow(search, chain, growth, nullptr);
    } catch (const SearchExhausted&) {
        selection.ended = search.over().value_or(Ended::budget);
    } catch (const BudgetEnded& ended) {
        selection.ended = ended.how();
    }
    evidence.budget().end_search();
    search.limit(false);
    if (by_forces && is_off(search, chain, Signal::encoder)) {
        try {
            by_forces = with_carriage_of(search, chain, *by_forces);
        } catch (const BudgetEnded& ended) {
            selection.ended = ended.how();  // it stands as it was found
        }
        if (is_better(search, *by_forces, chain)) chain = *std::move(by_forces);
    }
    std::erase_if(selection.alone, [](const Trial& trial) { return trial.candidate->is_limit; });
    try {
        if (search.is_at_floor(chain.fitted)) selection.limits = limits_in(chain);
        chain = nameable(search, chain);
        put_largest_first(search, chain);
        for (std::size_t k = 0; k < chain.choices.size(); ++k)
            chain.choices[k].left_out = left_out_of(search, chain, k);
        std::vector<CrossFit> steps;
        for (std::size_t k = 1; k < chain.choices.size(); ++k) steps.push_back(first_of(search, chain, k));
        selection.steps.insert(selection.steps.end(), steps.begin(), steps.end());
    } catch (const BudgetEnded& ended) {
        selection.ended = ended.how();
        // What each effect is worth by itself was not worked out.
        for (std::size_t k = 1; k < chain.choices.size(); ++k) selection.steps.push_back(chain.fitted);
    }
    if (!chain.choices.empty()) selection.steps.push_back(chain.fitted);
    selection.choices = std::move(chain.choices);
    return selection;
}

}  // namespace fidservo::gap
