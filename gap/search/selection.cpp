// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/search/selection.h"

#include "gap/fit/incremental_prediction.h"
#include "gap/numbers.h"
#include "gap/search/at_once.h"
#include "gap/search/exchange.h"
#include "gap/search/growth.h"
#include "gap/search/one_or_several.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <utility>

namespace fidservo::gap {
namespace {

/// Whether two effects explain well enough what no single effect was accepted for: two wrong ones fit most
/// data a little, and a little more than by chance.
bool explains(const Search& search, const CrossFit& without, const CrossFit& with) {
    constexpr double times_chance = 2.0;
    return search.nearly_clears(without, with) || (search.nearly_clears(without, with, nearly_all) &&
                                                   search.is_no_chance(without, with, times_chance));
}

/// Where signals stay off their floors, the effects accepted for them one after the other may not lead to the
/// true ones. Instead of these, tries each of the best single effects together with what is best beside it.
/// Where nothing was accepted, two effects may hide each other, so that candidates that promise little are
/// tried as the first of a pair, too.
/// @return whether the chain was changed
bool begin_otherwise(Search& search, Chain& chain, std::size_t most_effects) {
    constexpr Effort effort{.fits = narrow_beam, .leaders = 1};
    const SignalFlags off = search.off(chain.fitted);
    if (off == SignalFlags{}) return false;
    const Chain rest = rest_of(search, chain, off);
    if (!has_room_for_two(rest, most_effects)) return false;
    const bool from_nothing = chain.choices.size() == rest.choices.size();
    bool changed = false;
    constexpr std::size_t most_from_nothing = 6, most_otherwise = narrow_beam;
    const std::size_t most_first = from_nothing ? most_from_nothing : most_otherwise;
    std::vector<Trial> singles = search.try_all(rest.fitted, rest.candidates(), {.scatters = false});
    if (!from_nothing && has_leader(singles)) {
        Chain one = grown(search, rest, singles);
        if (is_better(search, one, chain)) {
            chain = std::move(one);
            changed = true;
            if (search.is_at_floor(chain.fitted)) return true;
        }
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

std::vector<const Candidate*> limits_in(const Chain& chain) {
    std::vector<const Candidate*> limits;
    for (const Choice& choice : chain.choices)
        if (choice.candidate->is_limit) limits.push_back(choice.candidate);
    return limits;
}

/// The chain without those effects that must not be named because they were tried only as the simpler form of
/// another effect (Candidate::is_limit). The rest is fitted again.
Chain nameable(const Search& search, Chain chain) {
    for (std::size_t k = chain.choices.size(); k-- > 0;)
        if (chain.choices[k].candidate->is_limit) chain = without(search, chain, k);
    return chain;
}

/// Like nameable(), but nothing is fitted or predicted again: the remaining effects keep the values and the
/// loss that the whole chain had.
Chain nameable_as_judged(Chain chain) {
    for (std::size_t k = chain.choices.size(); k-- > 0;) {
        if (!chain.choices[k].candidate->is_limit) continue;
        const auto at = static_cast<std::ptrdiff_t>(k);
        chain.choices.erase(chain.choices.begin() + at);
        for (Hypothesis& hypothesis : chain.fitted.of_half) hypothesis.erase(hypothesis.begin() + at);
    }
    return chain;
}

/// Sorts the effects by the gap that each alone would make, largest first.
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

/// The cross fit with the first `count` effects of a chain alone.
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
    const Wanted wanted = everything(evidence);
    IncrementalPrediction predict(evidence, {}, wanted);
    return fit(std::ref(predict), evidence.windows(), wanted, cross.of_half[0],
               {.most_iterations = few_iterations, .tolerance = close_tolerance, .with_covariance = true});
}

Selection select(const Evidence& evidence, const std::vector<Candidate>& candidates,
                 const SelectionOptions& options) {
    Search search(evidence, candidates, options.search);
    Selection selection;
    Chain chain{{}, search.nothing()};
    Aside aside;
    std::optional<Chain>& by_forces = aside.by_forces;
    selection.steps.push_back(chain.fitted);
    try {
        const AtOnce at_once = explain_at_once(search, chain, aside, selection.alone);
        bool are_several = at_once.are_several;
        const std::size_t most_effects = chain.choices.size() + options.most_effects;
        std::vector<Trial> tried;
        const Growth growth{.most_effects = most_effects, .scans = !at_once.is_balanced};
        are_several = grow(search, chain, growth, &tried) || are_several;
        add_tried(selection.alone, std::move(tried));
        search.limit(true);
        if (!are_several || !search.leaves_little(chain.fitted))
            are_several = begin_otherwise(search, chain, most_effects) || are_several;
        // The effects of a long chain were tested when they were fitted together.
        if (!is_long(chain) && exchange(search, chain, are_several)) grow(search, chain, growth, nullptr);
        search.limit(false);
        if (at_once.do_tags_wait) explain_waiting_tags(search, chain);
    } catch (const SearchExhausted&) {
        selection.ended = search.over().value_or(Ended::budget);
    } catch (const BudgetEnded& ended) {
        selection.ended = ended.how();
    }
    evidence.budget()->end_search();
    search.limit(false);
    if (aside.smooth) {
        try {
            chain = joined(search, chain, *aside.smooth);
        } catch (const BudgetEnded& ended) {
            selection.ended = ended.how();
            if (aside.smooth->fitted.loss < chain.fitted.loss) chain = *std::move(aside.smooth);
        }
    }
    if (by_forces && search.off(chain.fitted)[index_of(Signal::encoder)]) {
        try {
            by_forces = with_carriage_of(search, chain, *by_forces);
        } catch (const BudgetEnded& ended) {
            selection.ended = ended.how();  // the chain stays as it was found
        }
        if (is_better(search, *by_forces, chain)) chain = *std::move(by_forces);
    }
    std::erase_if(selection.alone, [](const Trial& trial) { return trial.candidate->is_limit; });
    try {
        if (search.is_at_floor(chain.fitted)) selection.limits = limits_in(chain);
        chain = without_needless(search, evidence, nameable(search, chain));
        chain = without_hindrances(search, chain);
        put_largest_first(search, chain);
        std::vector<CrossFit> steps;
        for (std::size_t k = 1; k < chain.choices.size(); ++k) steps.push_back(first_of(search, chain, k));
        selection.steps.insert(selection.steps.end(), steps.begin(), steps.end());
    } catch (const BudgetEnded& ended) {
        selection.ended = ended.how();
        chain = nameable_as_judged(std::move(chain));
        // The cross fits with the first effects alone were not finished.
        for (std::size_t k = 1; k < chain.choices.size(); ++k) selection.steps.push_back(chain.fitted);
    }
    if (!chain.choices.empty()) selection.steps.push_back(chain.fitted);
    selection.choices = std::move(chain.choices);
    return selection;
}

}  // namespace fidservo::gap
