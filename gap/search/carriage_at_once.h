// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// An explanation of the carriage's motion by forces that balance, and by what is no force beside them.
#include "gap/search/chain.h"

#include <optional>
#include <vector>

namespace fidservo::gap {

/// Chains that are kept aside.
struct Aside {
    /// The whole chain with a model from the balance of forces that leaves the encoder off its floor. The
    /// chain itself then loses its effects on the carriage's motion, so that the search for these can begin
    /// afresh.
    std::optional<Chain> by_forces;
    /// Whether that model removes most of the encoder's excess by forces alone. Many effects that leave most
    /// of it stand in for something else, and so do forces beside a late command.
    bool is_by_forces_mostly = false;
    /// While the carriage is explained: the smooth effects of Hall reading and tags, to be joined to the
    /// chain afterwards, or where the search ends meanwhile.
    std::optional<Chain> smooth;
};

/// Explains the encoder by a model from the balance of the carriage's forces. What these leave is explained
/// by what is best beside them, where they explain most; where they do not, by one effect that is no force
/// and the forces beside it.
/// @param alone  trials of single effects; those made here are added
/// @return whether the search for more is to start from there
bool explain_carriage(Search& search, Chain& chain, Aside& aside, std::vector<Trial>& alone);

/// The same by forces alone, where an effect of the encoder's reading has been found since: it makes the
/// motion known better, and with it the forces.
bool explain_carriage_again(Search& search, Chain& chain, Aside& aside, std::vector<Trial>& alone);

/// A chain without effects on the carriage's motion. Effects on its reading stay, since tags show them, too.
Chain without_carriage(const Search& search, const Chain& chain);

/// A chain whose effects on the carriage's motion or its encoder are replaced by those of another chain.
Chain with_carriage_of(const Search& search, const Chain& chain, const Chain& other);

}  // namespace fidservo::gap
