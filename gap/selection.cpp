#include "gap/selection.h"

#include "gap/search.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <utility>

namespace fidservo::gap {
namespace {

/// Of a signal's excess, what two effects that are taken in at once have to take away.
constexpr double nearly_all = 0.98;

/// The explanation as it grows.
struct Chain {
    std::vector<Choice> choices;
    CrossFit fitted;  ///< with all of them

    std::vector<const Candidate*> candidates() const {
        std::vector<const Candidate*> all;
        for (const Choice& choice : choices) all.push_back(choice.candidate);
        return all;
    }
};

Choice choice_of(const Search& search, const CrossFit& beside, std::vector<Trial> trials) {
    Choice choice{trials.front().candidate, beside.loss, {}, {}};
    for (std::size_t k = 1; k < trials.size(); ++k)
        if (trials[k].is_leader && !trials[k].candidate->is_limit && trials[k].gain > least_gain &&
            search.ties(trials[0].fitted, trials[k].fitted))
            choice.ties.push_back(trials[k].candidate);
    choice.alternatives = std::move(trials);
    return choice;
}

SignalFlags only_in(const SignalFlags& all, const SignalFlags& some) {
    SignalFlags rest{};
    for (std::size_t s = 0; s < signal_count; ++s) rest[s] = all[s] && !some[s];
    return rest;
}

/// A chain with one more effect. What has learnt from signals to which that effect only passes its change on
/// is fitted again: a platform that feels the carriage, where that moves otherwise.
Chain grown(const Search& search, Chain chain, std::vector<Trial> trials) {
    CrossFit fitted = trials.front().fitted;
    const Candidate& added = *trials.front().candidate;
    const SignalFlags passed_on = only_in(search.concerned_by(added, fitted), teachers_of(*added.effect));
    if (passed_on != SignalFlags{}) search.fit_again(fitted, passed_on);
    chain.choices.push_back(choice_of(search, chain.fitted, std::move(trials)));
    chain.fitted = std::move(fitted);
    return chain;
}

bool has_leader(const std::vector<Trial>& trials) {
    return !trials.empty() && trials.front().is_leader;
}

/// The chain without one of its effects, fitted anew.
Chain without(const Search& search, const Chain& chain, std::size_t left_out) {
    Chain shorter = chain;
    const SignalFlags concerned = search.concerned_by(*chain.choices[left_out].candidate, chain.fitted);
    const auto at = static_cast<std::ptrdiff_t>(left_out);
    shorter.choices.erase(shorter.choices.begin() + at);
    for (Hypothesis& hypothesis : shorter.fitted.of_half) hypothesis.erase(hypothesis.begin() + at);
    search.fit_again(shorter.fitted, concerned);
    return shorter;
}

/// Candidates of one chain that the other lacks.
std::vector<const Candidate*> only_in(const Chain& one, const Chain& other) {
    std::vector<const Candidate*> found = one.candidates();
    std::erase_if(found, [&](const Candidate* candidate) {
        return std::ranges::find(other.choices, candidate, &Choice::candidate) != other.choices.end();
    });
    return found;
}

/// Whether a chain is another one with a richer effect in the place of its limit.
bool refines(const Chain& richer, const Chain& plainer) {
    const auto more = only_in(richer, plainer), less = only_in(plainer, richer);
    return more.size() == 1 && less.size() == 1 &&
           is_limit_of(less.front()->effect->name, more.front()->effect->name);
}

/// Whether another chain explains better: the shorter or plainer one unless the other one's gain is no
/// chance.
bool is_better(const Search& search, const Chain& other, const Chain& chain) {
    if (other.choices.size() < chain.choices.size() || refines(chain, other))
        return !search.is_real(other.fitted, chain.fitted);
    if (other.choices.size() > chain.choices.size() || refines(other, chain))
        return search.is_real(chain.fitted, other.fitted);
    return other.fitted.loss < chain.fitted.loss - least_gain;
}

/// Puts two effects at once beside the rest, where they clear a share of a signal, or one of them alone,
/// fitted beside the other. Returns whether both are in.
/// @param is_needed  whether it is known otherwise that it takes both: any gain will do that is no chance, as
///                   a few windows that go another way may be all that is left
bool take_in_pair(Search& search, Chain& chain, const Chain& rest, std::optional<Pair> pair, double share,
                  bool is_needed) {
    if (!pair || !search.nearly_clears(rest.fitted, pair->fitted, share)) return false;
    search.limit(false);
    CrossFit first = pair->fitted;
    for (Hypothesis& hypothesis : first.of_half) hypothesis.pop_back();
    search.fit_again(first, search.concerned_by(*pair->second, pair->fitted));
    const auto trial = [](const Candidate& candidate, CrossFit fitted, double gain) {
        return std::vector{
            Trial{.candidate = &candidate, .gain = gain, .is_leader = true, .fitted = std::move(fitted)}};
    };
    const double loss = pair->fitted.loss, loss_of_first = first.loss;
    const Chain one =
        grown(search, rest, trial(*pair->first, std::move(first), rest.fitted.loss - loss_of_first));
    Chain two = grown(search, one, trial(*pair->second, std::move(pair->fitted), one.fitted.loss - loss));
    const Chain other = without(search, two, rest.choices.size());
    // What the first one is worth shows beside the second.
    Choice& first_choice = two.choices[rest.choices.size()];
    first_choice.loss_without = other.fitted.loss;
    first_choice.alternatives.front().gain = other.fitted.loss - two.fitted.loss;
    const bool are_both_in =
        is_better(search, two, chain) || (is_needed && search.is_no_chance(chain.fitted, two.fitted));
    if (are_both_in) {
        chain = std::move(two);
    } else {
        // Beside the other one an effect may have come to what it did not come to alone.
        for (const Chain& alone : {other, one})
            if (alone.choices.size() == chain.choices.size() && is_better(search, alone, chain))
                chain = alone;
    }
    search.limit(true);
    return are_both_in;
}

/// The chain without what has a say in some signals.
Chain rest_of(const Search& search, const Chain& chain, const SignalFlags& signals) {
    Chain rest = chain;
    for (std::size_t k = chain.choices.size(); k-- > 0;)
        if (meet(teachers_of(*chain.choices[k].candidate->effect), signals)) rest = without(search, rest, k);
    return rest;
}

/// Where a carriage stays off, what balances its forces best instead of what was taken in for it.
/// @param only_needed  two that the balance needs both
/// @return whether anything changed
bool balance(Search& search, Chain& chain, int most_effects, bool only_needed) {
    if (!search.off(chain.fitted)[index_of(Signal::encoder)]) return false;
    const Chain rest = rest_of(search, chain, only(Signal::encoder));
    if (static_cast<int>(rest.choices.size()) + 2 > most_effects) return false;
    return take_in_pair(search, chain, rest,
                        search.balanced_pair(rest.fitted, rest.candidates(), only_needed), nearly_all,
                        only_needed);
}

/// Takes in a weak wave that a scan has found, instead of the last effect; where that one gains more, since
/// it stands in for the wave and something else, the wave together with what is best beside it.
/// @return whether two effects took the place of the last one
bool take_in_scanned(Search& search, Chain& chain, const Chain& before, int most_effects) {
    constexpr Effort effort{.scatters = false};
    std::vector<Trial> trials = search.try_all(before.fitted, before.candidates(), effort);
    const auto grown_by = [&](const Chain& shorter, std::vector<Trial> added) {
        search.limit(false);
        Chain longer = grown(search, shorter, std::move(added));
        search.limit(true);
        return longer;
    };
    if (trials.front().fitted.loss < chain.fitted.loss) {
        chain = grown_by(before, std::move(trials));
        return false;
    }
    const auto wave = std::ranges::find_if(
        trials, [](const Trial& trial) { return trial.is_leader && trial.candidate->wave.has_value(); });
    if (wave == trials.end() || static_cast<int>(before.choices.size()) + 2 > most_effects) return false;
    const Chain one = grown_by(before, {*wave});
    std::vector<Trial> others = search.try_all(one.fitted, one.candidates(), effort);
    if (!has_leader(others)) return false;
    Chain two = grown_by(one, std::move(others));
    if (!is_better(search, two, chain)) return false;
    chain = std::move(two);
    return true;
}

/// Where a carriage stays off with what was taken in for it last: two effects instead that its forces need
/// both; where it stays far off, a weak wave, which no balance of forces shows, beside the one that it shows
/// or alone; and instead of a wave that does not balance the forces alone, any two that do.
/// @return whether a pair took the place of the last effect
bool look_further(Search& search, Chain& chain, const Chain& before, int most_effects) {
    if (balance(search, chain, most_effects, true)) return true;
    constexpr double floors_of_a_way = 10.0;  // that another way leaves
    const auto is_far_off = [&](double floors) {
        return search.far_off(chain.fitted, floors)[index_of(Signal::encoder)];
    };
    if (is_far_off(floors_of_a_way) && static_cast<int>(before.choices.size()) + 2 <= most_effects &&
        take_in_pair(search, chain, before, search.scanned_pair(before.fitted, before.candidates()),
                     nearly_all, false))
        return true;
    if (is_far_off(floors_of_a_way) && search.scan_for_wave(before.fitted, before.candidates()) &&
        take_in_scanned(search, chain, before, most_effects))
        return true;
    const Candidate& last = *chain.choices.back().candidate;
    return is_far_off(3.0) && last.wave && !search.balances_alone(before.fitted, before.candidates(), last) &&
           balance(search, chain, most_effects, false);
}

/// Takes in what is best, as long as it is no chance; for a carriage or a wire that one effect leaves off,
/// two at once. A weak wave is scanned for where the carriage stays far off; one that leaves something is
/// looked for among many values once nothing is found beside it.
/// @return whether a pair took the place of something
bool grow(Search& search, Chain& chain, int most_effects, std::vector<Trial>* first_step) {
    bool is_balanced = false, is_paired = false, is_of_two = false;
    std::optional<Chain> before_wave;  // that leaves something
    const auto is_far_off = [&] { return search.far_off(chain.fitted)[index_of(Signal::encoder)]; };
    const auto take_in = [&](const Chain& before, std::vector<Trial> found) {
        search.limit(false);
        chain = grown(search, before, std::move(found));
        search.limit(true);
    };
    while (static_cast<int>(chain.choices.size()) < most_effects) {
        const Chain before = chain;
        std::vector<Trial> trials = search.try_all(chain.fitted, chain.candidates(), {.scatters = false});
        if (first_step != nullptr) *first_step = trials;
        first_step = nullptr;
        if (!has_leader(trials) || !search.is_real(chain.fitted, trials.front().fitted)) {
            if (!before_wave || chain.choices.size() != before_wave->choices.size() + 1) return is_paired;
            take_in(*before_wave, search.try_all(before_wave->fitted, before_wave->candidates()));
            before_wave.reset();
            continue;
        }
        const bool moves_carriage = teachers_of(*trials.front().candidate->effect)[index_of(Signal::encoder)],
                   moves_wire = is_of_wire(*trials.front().candidate);
        take_in(before, std::move(trials));
        if (moves_carriage && !is_balanced) {
            is_balanced = true;
            is_paired = look_further(search, chain, before, most_effects);
            if (!is_paired && is_far_off() && chain.choices.back().candidate->wave) before_wave = before;
        }
        search.limit(true);
        if (moves_wire && !is_of_two && search.leaves_much(chain.fitted)[index_of(Signal::hall)] &&
            static_cast<int>(before.choices.size()) + 2 <= most_effects) {
            is_of_two = true;
            if (take_in_pair(search, chain, before, search.wire_pair(before.fitted, before.candidates()),
                             nearly_all, false))
                is_paired = true;
        }
        if (search.is_at_floor(chain.fitted)) return is_paired;
    }
    return is_paired;
}

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

/// Where signals stay off their floors, what was taken in for them, one after the other, may be no step on
/// the way to what there is: instead of it each of the best single effects, with what is best beside it.
/// Where nothing was taken in, two effects may hide each other: what promises a little is tried as the first
/// of a pair, which has to explain nearly all, as two wrong effects fit most things a little.
/// @return whether anything changed
bool pair_up(Search& search, Chain& chain, int most_effects) {
    constexpr Effort effort{.fits = 3, .leaders = 1};
    const SignalFlags off = search.off(chain.fitted);
    if (off == SignalFlags{}) return false;
    constexpr double all_but_nothing = 0.999;
    const Chain rest = rest_of(search, chain, off);
    if (static_cast<int>(rest.choices.size()) + 2 > most_effects) return false;
    const bool from_nothing = chain.choices.size() == rest.choices.size();
    if (balance(search, chain, most_effects, false) && search.is_at_floor(chain.fitted)) return true;
    if (take_in_pair(search, chain, rest, search.best_pair(rest.fitted, rest.candidates()), all_but_nothing,
                     false) &&
        search.is_at_floor(chain.fitted))
        return true;
    const std::size_t most_first = from_nothing ? 6 : 3;
    std::vector<Trial> singles = search.try_all(rest.fitted, rest.candidates());
    if (from_nothing) std::ranges::stable_sort(singles, std::greater{}, &Trial::promised);
    std::vector<std::string> classes;
    bool changed = false;
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
        if (!is_better(search, two, chain) ||
            (from_nothing && !search.nearly_clears(chain.fitted, two.fitted)))
            continue;
        chain = std::move(two);
        changed = true;
        if (search.is_at_floor(chain.fitted)) break;
    }
    return changed;
}

/// The chain without what cannot be named.
Chain nameable(const Search& search, Chain chain) {
    for (std::size_t k = chain.choices.size(); k-- > 0;)
        if (chain.choices[k].candidate->is_limit) chain = without(search, chain, k);
    return chain;
}

/// The chain with that first which the rest can least do without.
Chain weightiest_first(const Search& search, Chain chain) {
    const std::size_t count = chain.choices.size();
    if (count < 2) return chain;
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t k = 0; k < count; ++k) order.emplace_back(without(search, chain, k).fitted.loss, k);
    std::ranges::stable_sort(order, std::greater{}, &std::pair<double, std::size_t>::first);
    const auto in_order = [&](auto& values) {
        auto sorted = values;
        for (std::size_t k = 0; k < count; ++k) sorted[k] = std::move(values[order[k].second]);
        values = std::move(sorted);
    };
    in_order(chain.choices);
    for (Hypothesis& hypothesis : chain.fitted.of_half) in_order(hypothesis);
    return chain;
}

/// The first `count` effects of a chain alone.
CrossFit first_of(const Search& search, const Chain& chain, std::size_t count) {
    CrossFit fitted = chain.fitted;
    SignalFlags concerned{};
    for (std::size_t k = count; k < chain.choices.size(); ++k)
        concerned = either(concerned, search.concerned_by(*chain.choices[k].candidate, chain.fitted));
    for (Hypothesis& hypothesis : fitted.of_half) hypothesis.resize(count);
    search.fit_again(fitted, concerned);
    return fitted;
}

}  // namespace

Fit fit_to_all(const Evidence& evidence, const CrossFit& cross) {
    constexpr int most_iterations = 6;  // from what fits half of it
    const Wanted wanted = everything(evidence);
    const Predict predict = [&](const Hypothesis& hypothesis) { return evidence.errors(hypothesis, wanted); };
    return fit(predict, evidence.windows(), wanted, cross.of_half[0],
               {.most_iterations = most_iterations,
                .tolerance = 1e-6,
                .with_covariance = true,
                .threads = Threads::all});
}

Selection select(const Evidence& evidence, const std::vector<Candidate>& candidates,
                 const SelectionOptions& options) {
    Search search(evidence, candidates, options.search);
    Selection selection;
    Chain chain{{}, search.nothing()};
    selection.steps.push_back(chain.fitted);
    try {
        bool is_paired = grow(search, chain, options.most_effects, &selection.alone);
        search.limit(true);
        if (!is_paired || !search.leaves_little(chain.fitted))
            is_paired = pair_up(search, chain, options.most_effects) || is_paired;
        if (exchange(search, chain, is_paired)) grow(search, chain, options.most_effects, nullptr);
    } catch (const SearchExhausted&) {
        selection.is_cut_short = true;
    }
    search.limit(false);
    chain = weightiest_first(search, nameable(search, std::move(chain)));
    std::erase_if(selection.alone, [](const Trial& trial) { return trial.candidate->is_limit; });
    for (std::size_t k = 1; k < chain.choices.size(); ++k)
        selection.steps.push_back(first_of(search, chain, k));
    if (!chain.choices.empty()) selection.steps.push_back(chain.fitted);
    selection.choices = std::move(chain.choices);
    return selection;
}

}  // namespace fidservo::gap
