// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// An explanation while effects are added to it.
#include "gap/search/search.h"

#include <cstddef>
#include <functional>
#include <vector>

namespace fidservo::gap {

/// An effect accepted into the explanation.
struct Choice {
    const Candidate* candidate = nullptr;
    double loss_without = 0.0;                ///< loss of the explanation to which it was added
    std::vector<Trial> alternatives = {};     ///< what was tried in its place, itself first
    std::vector<const Candidate*> ties = {};  ///< alternatives that explain as well
    /// Gap that it alone would make in the rig as its file describes it, in floors; 1: not computed.
    double gap_alone = 1.0;
    CrossFit left_out = {};  ///< the explanation without it; empty: not computed
};

/// The effects of an explanation, and their cross fit.
struct Chain {
    std::vector<Choice> choices;
    CrossFit fitted;

    std::vector<const Candidate*> candidates() const;
};

/// Whether a chain has so many effects that refitting the rest without each of them would take too long.
bool is_long(const Chain& chain);

bool has_room_for_two(const Chain& chain, std::size_t most_effects);

/// The choice of the first of these trials, each of which was added to the explanation `beside`.
Choice choice_of(const Search& search, const CrossFit& beside, std::vector<Trial> trials);

/// Whether the first trial is a leader: fitted on both halves, as those are that gain most.
bool has_leader(const std::vector<Trial>& trials);

/// A chain with one more effect, the first of the trials. If that effect moves a carriage whose motion
/// affects the platform, effects estimated from the Hall reading are refitted.
Chain grown(const Search& search, Chain chain, std::vector<Trial> trials);

/// The chain without one of its effects; those that depend on it are refitted.
Chain without(const Search& search, const Chain& chain, std::size_t left_out);

/// Appends those choices of a chain, with their settings, whose effects satisfy `wants`.
void add_choices(Chain& to, const Chain& from, const std::function<bool(const plant::Effect&)>& wants);

/// The explanation without one of a chain's effects, the others as they were fitted beside it.
CrossFit without_refit(const Search& search, const Chain& chain, std::size_t left_out);

/// A chain whose effects are replaced by their simpler forms where what is richer about them is not real
/// (Search::is_real), as where friction is found to be the same in both directions; or may be chance, where
/// signals that it changes are off their floors, beside which no small part of an effect is real.
Chain in_plain_forms(const Search& search, Chain chain);

/// The chain without the effects that are estimated from any of the given signals.
Chain rest_of(const Search& search, const Chain& chain, const SignalFlags& signals);

/// Whether another chain explains better. If one of the two is shorter, or has the simpler form of the
/// other's effect, it is better unless the other one's gain is real (Search::is_real); otherwise the loss
/// decides.
bool is_better(const Search& search, const Chain& other, const Chain& chain);

}  // namespace fidservo::gap
