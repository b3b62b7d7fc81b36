// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Whether a deviation from the rig file belongs to one unit, to a batch, or to all units.
//
// The level of each unit is explained by a sum of shares and by a random difference d between units. A share
// m is a deviation that a set of units has in common: all units, a group of them, or a single one.
//
//     y_u = sum_j m_j [u in set j] + d_u + e_u,   d_u ~ N(0, tau^2),   e_u ~ N(0, s_u^2),   m_j ~ N(0, g_j^2)
//
// The likelihood is averaged over tau (prior flat in its logarithm from 0.05 to 200 floors, with half of the
// weight on 0) and over g = 1, 4, 16 and 64 floors. In this marginal likelihood, one share of many units
// costs one free parameter, many shares of single units cost one each. Beginning without shares, the share
// with the largest marginal likelihood is added while the posterior odds for it are 19 to 1 or more. If no
// single share has such odds, the next few are added if they have them together, since several deviating
// units hide each other by increasing tau. Finally, shares without such odds beside the others are removed.
// The prior odds correct for multiple testing: one of Q quantities deviates, and it is equally likely that
// all units, a group, or a unit deviates, with equal probabilities for each group and for each unit:
//
//     log odds = log likelihood ratio + log(1 / (3 Q)) - log(number of sets of its kind)
//
// A subset of the units that is not a given group, for example about half of them, can have a share, too, if
// both the subset and its complement have more units than are listed one by one (8, or a third of all). Of N
// units, each size k of the subset is equally likely, and so is each subset of this size, which costs log N +
// log(N over k) in log odds; the subsets tried are the k units with the largest or the smallest residuals. If
// the units differ by a normal distribution only, no subset is worth its cost: dividing N units into halves
// costs N log 2.
//
// For the choice of shares, levels that are known only by a limit are replaced by normal distributions
// (as_normal()); the estimates of the sizes use the limits (limited_sizes.h). Sources: Kass, Raftery, JASA
// 90, 1995; Scott, Berger, Ann. Stat. 38, 2010 (multiplicity by prior odds).
#include "src/fleet/report/statistics/point.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace fidservo::fleet {

/// To whom a deviation belongs.
enum class Whose { all, group, unit };

/// A deviation that belongs to a set of units.
struct Share {
    Whose whose = Whose::all;
    std::optional<std::size_t> which;  ///< index of the group or unit; empty: another subset
    std::vector<std::size_t> units;    ///< the units of the set
    Level size;                        ///< m, given the other deviations, floors
    double log_odds = 0.0;             ///< natural log odds against its absence, beside the other deviations
    double probability = 0.0;          ///< probability among this set, none, and all other sets
    /// Natural logarithms of likelihood ratios against no share: of the best set of each kind in place of
    /// this one.
    double log_all = 0.0, log_group = 0.0, log_unit = 0.0;
};

/// An explanation of all units' levels.
struct Attribution {
    std::vector<Share> shares;   ///< in the order in which they were found
    double spread = 0.0;         ///< tau, most probable value, floors: the units' other differences
    std::vector<double> levels;  ///< of each unit: its value, or its expected value given its limit; floors
};

/// @param levels  of all units, as limits where they are not named. With fewer than three units nothing can
/// be attributed, and there are no shares
/// @param groups  sets of units that may share a cause, each of at least two units but not all
/// @param quantities  Q, the number of quantities that are tested
Attribution attribute(std::span<const Level> levels, std::span<const std::vector<std::size_t>> groups,
                      double quantities);

}  // namespace fidservo::fleet
