// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/search/growth.h"

#include "gap/starts/scatter.h"

#include <algorithm>
#include <utility>

namespace fidservo::gap {
namespace {

/// A chain with one more effect, fitted without a limit of effort, so that what has been found is not lost.
Chain grown_whatever(Search& search, const Chain& chain, std::vector<Trial> trials) {
    search.limit(false);
    Chain longer = grown(search, chain, std::move(trials));
    search.limit(true);
    return longer;
}

/// Replaces the last effect by a weak wave that a scan has found, if that gains more. If the last effect
/// gains more, it may stand in for the wave and a further effect: the wave and the best effect beside it then
/// replace it if these two explain better.
/// @return whether two effects have replaced the last one
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

}  // namespace

bool grow(Search& search, Chain& chain, const Growth& growth, std::vector<Trial>* first_step) {
    bool has_scanned = !growth.scans, are_two = false;
    const auto is_far_off = [&] { return search.far_off(chain.fitted)[index_of(Signal::encoder)]; };
    while (chain.choices.size() < growth.most_effects) {
        const Chain before = chain;
        std::vector<Trial> trials =
            search.try_all(chain.fitted, chain.candidates(), {.fits = growth.fits, .scatters = false});
        if (first_step != nullptr) *first_step = trials;
        first_step = nullptr;
        if (!has_leader(trials) || !search.is_real(chain.fitted, trials.front().fitted)) {
            if (is_far_off() && search.scan_for_wave(chain.fitted, chain.candidates())) continue;
            return are_two;
        }
        const bool is_of_carriage = moves_carriage(*trials.front().candidate->effect);
        chain = grown_whatever(search, before, std::move(trials));
        search.throw_if_over();
        if (is_of_carriage && !has_scanned && is_far_off()) {
            has_scanned = true;
            if (search.scan_for_wave(before.fitted, before.candidates()))
                are_two = take_in_scanned(search, chain, before, growth.most_effects);
            if (!are_two && is_far_off() && has_valleys(*chain.choices.back().candidate))
                chain = grown_whatever(search, before, search.try_all(before.fitted, before.candidates()));
        }
        if (search.is_at_floor(chain.fitted)) return are_two;
    }
    return are_two;
}

}  // namespace fidservo::gap
