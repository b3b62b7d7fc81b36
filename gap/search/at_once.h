// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Explanations by several effects fitted at once, made before effects are looked for one by one.
#include "gap/search/carriage_at_once.h"

#include <vector>

namespace fidservo::gap {

struct AtOnce {
    /// A model from the balance of forces is kept: it brings the encoder to its floor, or so near that the
    /// search starts from there.
    bool is_balanced;
    bool are_several;  ///< more than one effect was accepted in one step
    /// Tags wait for a carriage that is still far off, as its place when frames were taken is known within a
    /// count only where its motion is predicted.
    bool do_tags_wait;
};

/// Explains Hall reading and tags by all smooth effects at once, the encoder by a model from the balance of
/// the carriage's forces, and what is left of Hall reading and tags by effects with a shape of their own;
/// each of these by a single effect where that does as well. A Hall reading that is still further off than
/// all else is explained before the carriage. Where an effect of the encoder's reading is found then, by
/// which motion and forces are known better, the carriage is explained once more.
/// @param alone  trials of single effects; those made here are added
AtOnce explain_at_once(Search& search, Chain& chain, Aside& aside, std::vector<Trial>& alone);

/// Explains tags that are off their floor by effects that have shapes of their own, with all smooth effects
/// that are then needed, unless the carriage is still far off.
void explain_waiting_tags(Search& search, Chain& chain);

/// A chain with those effects of another one that it lacks. What Hall reading and tags tell is refitted, as
/// the carriage's motion shows in them.
Chain joined(const Search& search, const Chain& chain, const Chain& other);

}  // namespace fidservo::gap
