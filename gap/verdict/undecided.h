// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the recordings cannot decide, and why, in sentences for the user.
#include "gap/candidates/candidate.h"
#include "gap/search/selection.h"

#include <span>
#include <string>
#include <vector>

namespace fidservo::gap {

/// The candidates that would hardly show at their typical size: the sum over windows of 1/2 log(1 + d_w),
/// with d_w the mean square change of the predictions in floors^2, is less than 4, which is about the loss
/// that a search needs for a significant result.
std::vector<const Candidate*> hidden_candidates(const Evidence& evidence, std::span<const Candidate> tried,
                                                const Selection& selection);

/// One line each, what concerns most first:
///   - recordings that say that they are of another rig, and signals that the explained simulator predicts
///     worse than a rig that does not move at all (r.m.s. within windows): the rig file may be of another
///     rig;
///   - signals of the rig that no recording has, or of which nothing could be judged;
///   - effects that act at a place on the rail, where places are not known;
///   - that the search was cut short;
///   - by block, effects that would hardly show;
///   - parts of recordings that were not judged; of many recordings that share a reason, in one line.
/// @param hidden  result of hidden_candidates()
std::vector<std::string> undecided(const Evidence& evidence, std::span<const Candidate* const> hidden,
                                   const Selection& selection);

/// If a gap was found but no effect was accepted for lack of data: a sentence with the effect that would
/// remove most of the gap, at least half, and its values, or with the number of windows. Otherwise empty.
std::string what_is_wanting(const Evidence& evidence, const Selection& selection);

}  // namespace fidservo::gap
