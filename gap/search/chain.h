// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// An explanation as it grows.
#include "gap/search/search.h"

#include <cstddef>
#include <vector>

namespace fidservo::gap {

/// An effect that was taken in.
struct Choice {
    const Candidate* candidate = nullptr;
    double loss_without = 0.0;                ///< of what it was tried beside, alone
    std::vector<Trial> alternatives = {};     ///< everything that was tried in its place, itself first
    std::vector<const Candidate*> ties = {};  ///< of these, what does as well
    double gap_alone = 1.0;  ///< that it would make beside the rig file, in floors; 1: not worked out
    CrossFit left_out = {};  ///< the whole explanation without it, fitted anew; empty: not worked out
};

/// Effects, and the rig as it is explained with all of them.
struct Chain {
    std::vector<Choice> choices;
    CrossFit fitted;

    std::vector<const Candidate*> candidates() const;
};

bool has_room_for_two(const Chain& chain, std::size_t most_effects);

/// What was tried beside a cross fit, the first of it taken in.
Choice choice_of(const Search& search, const CrossFit& beside, std::vector<Trial> trials);

/// Whether anything tried is worth taking in.
bool has_leader(const std::vector<Trial>& trials);

/// A chain with one more effect, the first of those tried. What has learnt from signals to which that effect
/// only passes its change on is fitted again: a platform that feels the carriage, where that moves otherwise.
Chain grown(const Search& search, Chain chain, std::vector<Trial> trials);

/// The chain without one of its effects, fitted anew.
Chain without(const Search& search, const Chain& chain, std::size_t left_out);

/// The chain without what has a say in some signals.
Chain rest_of(const Search& search, const Chain& chain, const SignalFlags& signals);

/// Whether another chain explains better: the shorter or plainer one unless the other one's gain is no
/// chance.
bool is_better(const Search& search, const Chain& other, const Chain& chain);

}  // namespace fidservo::gap
