// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// An explanation of the carriage's motion by forces, found from their balance, and by effects that are not
// forces (play, a belt, a late command).
#include "gap/search/chain.h"

#include <optional>
#include <vector>

namespace fidservo::gap {

/// Chains that compete with the present one or are to be joined to it later.
struct Aside {
    /// The chain with a model from the balance of forces, if that model leaves the encoder off its floor. The
    /// search for effects on the carriage's motion then begins afresh, from the chain without any, and its
    /// result competes with this one.
    std::optional<Chain> by_forces;
    /// Whether all effects of `by_forces` on the carriage's motion are forces and remove most of the
    /// encoder's excess over its floor. If they leave most of it, or need a late command as well, they only
    /// imitate another cause.
    bool is_by_forces_mostly = false;
    /// While the carriage is explained: the chain with the smooth effects of Hall reading and tags. They are
    /// joined to the chain afterwards, also if the search ends meanwhile.
    std::optional<Chain> smooth;
};

/// Explains the encoder by a model from the balance of the carriage's forces. If the model explains most of
/// the encoder's error, further effects are added to it; otherwise the encoder is explained by one effect
/// that is not a force and by the forces that are found beside that.
/// @param alone  trials of single effects; those made here are added
/// @return whether the encoder is at its floor, or so near that the search for further effects starts from
/// this model
bool explain_carriage(Search& search, Chain& chain, Aside& aside, std::vector<Trial>& alone);

/// Replaces all effects on the carriage's motion by a new model from the balance of forces if that is better.
/// To be called after an effect on the encoder's reading was found, since motion and forces are then known
/// better.
/// @return as explain_carriage()
bool explain_carriage_again(Search& search, Chain& chain, Aside& aside, std::vector<Trial>& alone);

/// A chain without its effects on the carriage's motion. Effects on the encoder's reading stay, since the
/// tags show them, too.
Chain without_carriage(const Search& search, const Chain& chain);

/// A chain whose effects on the carriage's motion or its encoder are replaced by those of another chain.
Chain with_carriage_of(const Search& search, const Chain& chain, const Chain& other);

}  // namespace fidservo::gap
