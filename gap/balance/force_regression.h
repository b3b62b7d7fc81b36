// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The combination of effects that balances a carriage's forces, without simulating the carriage: orthogonal
// forward regression (Chen, Billings, Luo, Int. J. Control 50, 1989).
//
// A candidate at a point of its grid is a group of columns: the change of the excess in all supports
// (gap/balance/force_balance.h) for a small fraction of each of its typical sizes. The next group added is
// the one that reduces the residual most, in squares weighted by 1 / (1 + (r / s)^2), with s twice the median
// residual or the noise. Groups are added as long as the next one passes a test on the other half of the
// data: the likelihood ratio there, with the sizes fitted on the first half, must exceed n / alpha, with n
// the number of groups and alpha the significance level. For data without the effect the expectation of the
// likelihood ratio is 1, so that it exceeds n / alpha with a probability of at most alpha / n (Markov's
// inequality).
#include "gap/balance/force_balance.h"
#include "gap/candidates/candidate.h"

#include <cstdint>
#include <span>
#include <vector>

namespace fidservo::gap {

struct BalancedModel {
    std::vector<const Candidate*> candidates;
    Hypothesis settings;  ///< the setting of each candidate
};

/// Whether a candidate's influence on the carriage at a row depends on that row alone, as that of a force
/// does. The influence of a belt or a delay depends on earlier rows; fitted to the balance, it would absorb
/// noise of the readings.
bool is_force(const Rig& rig, const Candidate& candidate);

/// The models of one effect, of two, and so on, refined by the balance on one half of the data
/// (gap/balance/balance_fit.h).
/// @param halves  the half to which each window belongs (gap/evidence/halves.h); the first half is fitted
/// @param base    the known effects
/// @param candidates  of these, the forces that are not in the base are tried, one of each class
/// @param tail  significance level alpha: probability of adding any effect if there is none
std::vector<BalancedModel> balanced_models(const Evidence& evidence, std::span<const std::uint8_t> halves,
                                           const Hypothesis& base,
                                           std::span<const Candidate* const> candidates, double tail);

}  // namespace fidservo::gap
