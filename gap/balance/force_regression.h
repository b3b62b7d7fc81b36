// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which effects of a carriage balance its forces together, without following it: orthogonal forward
// regression (Chen, Billings, Luo, Int. J. Control 50, 1989).
//
// A candidate at a point of its grid is a group of columns: what a small share of each of its typical sizes
// adds to the excess of all supports (gap/balance/force_balance.h). Taken in next is the group that takes
// away most of what those before it leave, in squares weighted by 1 / (1 + (r / s)^2), with s twice the
// median residual or the noise; as long as what is predicted by sizes fitted on the other half is likelier by
// more than n / alpha times, of n groups. Of data that have no such effect a ratio of likelihoods is 1 in the
// mean, so that it exceeds that by chance once in n / alpha at most (Markov).
#include "gap/balance/force_balance.h"
#include "gap/candidates/candidate.h"

#include <cstdint>
#include <span>
#include <vector>

namespace fidservo::gap {

struct BalancedModel {
    std::vector<const Candidate*> candidates;
    Hypothesis settings;  ///< of each
};

/// Whether what an effect does to a carriage at a row follows from that row, as a force does; what a belt or
/// a delay does follows from rows before, and noise of the readings would count for it.
bool is_force(const Rig& rig, const Candidate& candidate);

/// The models of one effect, of two, and so on, refined by the balance of one half
/// (gap/balance/balance_fit.h).
/// @param halves  of every window (gap/evidence/halves.h); the first one is fitted
/// @param base    what is known of the rig
/// @param candidates  those that are forces and not known are tried, one of a class
/// @param tail  of taking in anything where there is nothing
std::vector<BalancedModel> balanced_models(const Evidence& evidence, std::span<const std::uint8_t> halves,
                                           const Hypothesis& base,
                                           std::span<const Candidate* const> candidates, double tail);

}  // namespace fidservo::gap
