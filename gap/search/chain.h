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
    std::vector<Trial> alternatives = {};     ///< trials of that step, the accepted one first
    std::vector<const Candidate*> ties = {};  ///< alternatives that explain equally well (Search::ties)
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

/// Accepts the first of some trials. Each of them added one effect to the explanation `beside`.
Choice choice_of(const Search& search, const CrossFit& beside, std::vector<Trial> trials);

/// Whether the first trial was fitted on both halves (Trial::is_leader). False without trials.
bool has_leader(const std::vector<Trial>& trials);

/// A chain with one more effect, that of the first trial. Effects that are estimated from other signals than
/// the new one, but whose fits it influences, are refitted: for example those estimated from the Hall
/// reading, if the carriage's motion shows in it.
Chain grown(const Search& search, Chain chain, std::vector<Trial> trials);

/// The chain without one of its effects. The others are refitted as far as the missing one influenced their
/// fits.
Chain without(const Search& search, const Chain& chain, std::size_t left_out);

/// Appends those choices of a chain, with their settings, whose effects satisfy `wants`.
void add_choices(Chain& to, const Chain& from, const std::function<bool(const plant::Effect&)>& wants);

/// A chain's explanation without one of its effects; the others keep their values.
CrossFit without_refit(const Search& search, const Chain& chain, std::size_t left_out);

/// A chain in which each effect is replaced by its simpler form unless the richer form's additional gain is
/// real (Search::is_real). For example, friction by direction becomes plain friction if both directions are
/// found alike. While the effect's signals are off their floors, too small a share of the gap depends on the
/// richer form for is_real; the gain then only has to be significant (Search::is_no_chance).
Chain in_plain_forms(const Search& search, Chain chain);

/// The chain without the effects that are estimated from any of the given signals.
Chain rest_of(const Search& search, const Chain& chain, const SignalFlags& signals);

/// Whether `other` explains better than `chain`. A chain that has fewer effects, or differs only by the
/// simpler form of one effect, is better unless the additional gain of the richer chain is real
/// (Search::is_real). In all other cases the smaller loss decides.
bool is_better(const Search& search, const Chain& other, const Chain& chain);

}  // namespace fidservo::gap
