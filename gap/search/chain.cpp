// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/search/chain.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace fidservo::gap {
namespace {

SignalFlags only_in(const SignalFlags& all, const SignalFlags& some) {
    SignalFlags rest{};
    for (std::size_t s = 0; s < signal_count; ++s) rest[s] = all[s] && !some[s];
    return rest;
}

/// Candidates of one chain that the other lacks.
std::vector<const Candidate*> only_in(const Chain& one, const Chain& other) {
    std::vector<const Candidate*> found = one.candidates();
    std::erase_if(found, [&](const Candidate* candidate) {
        return std::ranges::find(other.choices, candidate, &Choice::candidate) != other.choices.end();
    });
    return found;
}

/// Whether two chains differ only in one effect, which is richer in the first and in its simpler form in the
/// second.
bool refines(const Chain& richer, const Chain& plainer) {
    const auto more = only_in(richer, plainer), less = only_in(plainer, richer);
    return more.size() == 1 && less.size() == 1 && is_limit_of(*less.front()->effect, *more.front()->effect);
}

/// Takes a setting out of both halves; the rest is not judged again.
void erase(CrossFit& cross, std::size_t setting) {
    for (Hypothesis& hypothesis : cross.of_half)
        hypothesis.erase(hypothesis.begin() + static_cast<std::ptrdiff_t>(setting));
}

}  // namespace

std::vector<const Candidate*> Chain::candidates() const {
    std::vector<const Candidate*> all;
    for (const Choice& choice : choices) all.push_back(choice.candidate);
    return all;
}

bool has_room_for_two(const Chain& chain, std::size_t most_effects) {
    return chain.choices.size() + 2 <= most_effects;
}

bool is_long(const Chain& chain) {
    constexpr std::size_t most_short = 4;
    return chain.choices.size() > most_short;
}

Choice choice_of(const Search& search, const CrossFit& beside, std::vector<Trial> trials) {
    Choice choice{.candidate = trials.front().candidate, .loss_without = beside.loss};
    for (std::size_t k = 1; k < trials.size(); ++k)
        if (trials[k].is_leader && !trials[k].candidate->is_limit && trials[k].gain > least_gain &&
            search.ties(trials[0].fitted, trials[k].fitted))
            choice.ties.push_back(trials[k].candidate);
    choice.alternatives = std::move(trials);
    return choice;
}

bool has_leader(const std::vector<Trial>& trials) {
    return !trials.empty() && trials.front().is_leader;
}

Chain grown(const Search& search, Chain chain, std::vector<Trial> trials) {
    CrossFit fitted = trials.front().fitted;
    const Candidate& added = *trials.front().candidate;
    const SignalFlags passed_on = only_in(search.concerned_by(added, fitted), teachers_of(*added.effect));
    if (passed_on != SignalFlags{}) search.fit_again(fitted, passed_on);
    chain.choices.push_back(choice_of(search, chain.fitted, std::move(trials)));
    chain.fitted = std::move(fitted);
    return chain;
}

Chain without(const Search& search, const Chain& chain, std::size_t left_out) {
    Chain shorter = chain;
    const SignalFlags concerned = search.concerned_by(*chain.choices[left_out].candidate, chain.fitted);
    shorter.choices.erase(shorter.choices.begin() + static_cast<std::ptrdiff_t>(left_out));
    erase(shorter.fitted, left_out);
    search.fit_again(shorter.fitted, concerned);
    return shorter;
}

void add_choices(Chain& to, const Chain& from, const std::function<bool(const plant::Effect&)>& wants) {
    for (std::size_t k = 0; k < from.choices.size(); ++k) {
        if (!wants(*from.choices[k].candidate->effect)) continue;
        to.choices.push_back(from.choices[k]);
        for (std::size_t side = 0; side < 2; ++side)
            to.fitted.of_half[side].push_back(from.fitted.of_half[side][k]);
    }
}

CrossFit without_refit(const Search& search, const Chain& chain, std::size_t left_out) {
    CrossFit rest = chain.fitted;
    erase(rest, left_out);
    search.judge(rest);
    return rest;
}

Chain in_plain_forms(const Search& search, Chain chain) {
    for (std::size_t k = 0; k < chain.choices.size(); ++k) {
        Chain plain = chain;
        for (Hypothesis& hypothesis : plain.fitted.of_half) {
            std::optional<Search::PlainForm> form = search.plain_form_of(hypothesis[k]);
            if (!form) break;
            plain.choices[k].candidate = form->candidate;
            hypothesis[k] = std::move(form->setting);
        }
        if (plain.choices[k].candidate == chain.choices[k].candidate) continue;
        Choice& choice = plain.choices[k];
        search.fit_again(plain.fitted, teachers_of(*choice.candidate->effect));
        const bool is_undecided = meet(search.off(chain.fitted), teachers_of(*choice.candidate->effect));
        if (search.is_real(plain.fitted, chain.fitted) ||
            (is_undecided && search.is_no_chance(plain.fitted, chain.fitted)))
            continue;
        Trial itself{.candidate = choice.candidate,
                     .gain = choice.loss_without - plain.fitted.loss,
                     .is_leader = true,
                     .fitted = plain.fitted};
        choice.alternatives = {std::move(itself)};
        choice.ties.clear();
        chain = std::move(plain);
    }
    return chain;
}

Chain rest_of(const Search& search, const Chain& chain, const SignalFlags& signals) {
    Chain rest = chain;
    for (std::size_t k = chain.choices.size(); k-- > 0;)
        if (meet(teachers_of(*chain.choices[k].candidate->effect), signals)) rest = without(search, rest, k);
    return rest;
}

bool is_better(const Search& search, const Chain& other, const Chain& chain) {
    if (other.choices.size() < chain.choices.size() || refines(chain, other))
        return !search.is_real(other.fitted, chain.fitted);
    if (other.choices.size() > chain.choices.size() || refines(other, chain))
        return search.is_real(chain.fitted, other.fitted);
    return other.fitted.loss < chain.fitted.loss - least_gain;
}

}  // namespace fidservo::gap
