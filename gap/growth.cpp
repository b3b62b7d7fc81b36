#include "gap/growth.h"

#include "gap/scatter.h"

#include <algorithm>
#include <utility>

namespace fidservo::gap {
namespace {

/// Of a signal's excess, what two effects that are taken in at once have to take away.
constexpr double nearly_all = 0.98;

/// A chain with one more effect, whatever that costs: what has been found is not lost.
Chain grown_whatever(Search& search, const Chain& chain, std::vector<Trial> trials) {
    search.limit(false);
    Chain longer = grown(search, chain, std::move(trials));
    search.limit(true);
    return longer;
}

/// Takes in a weak wave that a scan has found, instead of the last effect; where that one gains more, since
/// it stands in for the wave and something else, the wave together with what is best beside it.
/// @return whether two effects took the place of the last one
bool take_in_scanned(Search& search, Chain& chain, const Chain& before, std::size_t most_effects) {
    constexpr Effort effort{.scatters = false};
    std::vector<Trial> trials = search.try_all(before.fitted, before.candidates(), effort);
    if (!has_leader(trials)) return false;
    if (trials.front().fitted.loss < chain.fitted.loss) {
        chain = grown_whatever(search, before, std::move(trials));
        return false;
    }
    const auto wave = std::ranges::find_if(
        trials, [](const Trial& trial) { return trial.is_leader && trial.candidate->wave.has_value(); });
    if (wave == trials.end() || !has_room_for_two(before, most_effects)) return false;
    const Chain one = grown_whatever(search, before, {*wave});
    std::vector<Trial> others = search.try_all(one.fitted, one.candidates(), effort);
    if (!has_leader(others)) return false;
    Chain two = grown_whatever(search, one, std::move(others));
    if (!is_better(search, two, chain)) return false;
    chain = std::move(two);
    return true;
}

/// Where a carriage stays off with what was taken in for it last: two effects instead that its forces need
/// both; where it stays far off, a weak wave, which no balance of forces shows, beside the one that it shows
/// or alone; and instead of a wave that does not balance the forces alone, any two that do.
/// @return whether a pair took the place of the last effect
bool look_further(Search& search, Chain& chain, const Chain& before, std::size_t most_effects) {
    if (balance(search, chain, most_effects, true)) return true;
    constexpr double floors_of_a_way = 3.0;  // that another way leaves
    const auto is_far_off = [&](double floors) {
        return search.far_off(chain.fitted, floors)[index_of(Signal::encoder)];
    };
    if (is_far_off(floors_of_a_way) && has_room_for_two(before, most_effects) &&
        take_in_pair(search, chain, before, search.scanned_pair(before.fitted, before.candidates()),
                     nearly_all, false))
        return true;
    if (is_far_off(floors_of_a_way) && search.scan_for_wave(before.fitted, before.candidates()) &&
        take_in_scanned(search, chain, before, most_effects))
        return true;
    const Candidate& last = *chain.choices.back().candidate;
    return is_far_off(floors_of_a_way) && last.wave &&
           !search.balances_alone(before.fitted, before.candidates(), last) &&
           balance(search, chain, most_effects, false);
}

}  // namespace

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

bool balance(Search& search, Chain& chain, std::size_t most_effects, bool only_needed) {
    if (!search.off(chain.fitted)[index_of(Signal::encoder)]) return false;
    const Chain rest = rest_of(search, chain, only(Signal::encoder));
    if (!has_room_for_two(rest, most_effects)) return false;
    return take_in_pair(search, chain, rest,
                        search.balanced_pair(rest.fitted, rest.candidates(), only_needed, chain.fitted.loss),
                        nearly_all, only_needed);
}

bool grow(Search& search, Chain& chain, const Growth& growth, std::vector<Trial>* first_step) {
    bool is_balanced = !growth.in_pairs, is_paired = false, is_of_two = false;
    const auto is_far_off = [&] { return search.far_off(chain.fitted)[index_of(Signal::encoder)]; };
    while (chain.choices.size() < growth.most_effects) {
        const Chain before = chain;
        std::vector<Trial> trials = search.try_all(chain.fitted, chain.candidates(), {.scatters = false});
        if (first_step != nullptr) *first_step = trials;
        first_step = nullptr;
        if (!has_leader(trials) || !search.is_real(chain.fitted, trials.front().fitted)) {
            if (is_far_off() && search.scan_for_wave(chain.fitted, chain.candidates())) continue;
            return is_paired;
        }
        const bool is_of_carriage = moves_carriage(*trials.front().candidate->effect),
                   moves_wire = is_of_wire(*trials.front().candidate);
        chain = grown_whatever(search, before, std::move(trials));
        search.throw_if_over();
        if (is_of_carriage && !is_balanced) {
            is_balanced = true;
            is_paired = look_further(search, chain, before, growth.most_effects);
            if (!is_paired && is_far_off() && has_valleys(*chain.choices.back().candidate))
                chain = grown_whatever(search, before, search.try_all(before.fitted, before.candidates()));
        }
        if (moves_wire && growth.in_pairs && !is_of_two &&
            search.leaves_much(chain.fitted)[index_of(Signal::hall)] &&
            has_room_for_two(before, growth.most_effects)) {
            is_of_two = true;
            if (take_in_pair(search, chain, before, search.wire_pair(before.fitted, before.candidates()),
                             nearly_all, false))
                is_paired = true;
        }
        if (search.is_at_floor(chain.fitted)) return is_paired;
    }
    return is_paired;
}

}  // namespace fidservo::gap
