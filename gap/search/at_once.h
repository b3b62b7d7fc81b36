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
    /// The tags are to be explained later (explain_waiting_tags()), because the carriage's motion is still
    /// predicted badly: its place at the time of a frame is then not known to within a count.
    bool do_tags_wait;
};

/// Explains Hall reading and tags by all smooth effects at once, then the encoder by a model from the balance
/// of the carriage's forces, then the remaining errors of Hall reading and tags by effects with shape
/// parameters. In each case a single effect is preferred to several if it explains as well. If the Hall
/// reading is still the signal furthest off its floor after the smooth effects, it is explained before the
/// carriage. If an effect on the encoder's reading is found after the carriage was explained, the carriage is
/// explained again, since its motion and forces are then known better.
/// @param alone  trials of single effects; those made here are added
AtOnce explain_at_once(Search& search, Chain& chain, Aside& aside, std::vector<Trial>& alone);

/// Explains tags that are off their floor by effects with shape parameters and all smooth effects that are
/// needed beside these. Does nothing if the carriage is still far off.
void explain_waiting_tags(Search& search, Chain& chain);

/// `chain`, with those effects of `other` added that it lacks. If there are any, all effects that are
/// estimated from Hall reading or tags are refitted, since the carriage's motion shows in both signals.
Chain joined(const Search& search, const Chain& chain, const Chain& other);

}  // namespace fidservo::gap
