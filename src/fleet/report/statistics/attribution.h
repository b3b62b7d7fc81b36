// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Whether a deviation from the rig file is one unit's, a batch's, or everybody's.
//
// The levels of all units are explained by a sum of shares, each of which belongs to all units, to a group of
// them, or to one, and by what units differ by anyway:
//
//     y_u = sum_j m_j [u in set j] + d_u + e_u,   d_u ~ N(0, tau^2),   e_u ~ N(0, s_u^2),   m_j ~ N(0, g_j^2)
//
// tau is averaged over (flat in its logarithm from 0.05 to 200 floors, and half of the weight on 0), g over
// 1, 4, 16 and 64 floors. So each explanation has a marginal likelihood, in which a share that many units
// have at the same value is dear once, and many shares of single units are dear each time. Beginning with
// none, the share with the largest marginal likelihood is added while the odds for it are 19 to 1 or more,
// prior odds included; or the next few, where these have such odds together, as several units that are off
// hide each other behind the spread. At last, what has no such odds beside the others is taken away. The
// prior odds pay for having looked elsewhere: of Q quantities one is off, and with it all units, some group
// or some unit are equally likely, each group and each unit alike:
//
//     log odds = log likelihood ratio + log(1 / (3 Q)) - log(number of sets of its kind)
//
// A part of the units that no group is, as about half of them, is a set, too, if it and what is left have
// more units than are told one by one (8, or a third of all). Of N units every number k is equally likely for
// it, and of these all parts, so that it pays log N + log(N over k); the likeliest parts are the k units of
// which most, or least, is left. With normal spread of the units alone none pays: to tell N units into halves
// costs N log 2.
//
// Levels that are not named count as normal laws here (as_normal()); sizes allow for what they are
// (limited_sizes.h).
// Sources: Kass, Raftery, JASA 90, 1995; Scott, Berger, Ann. Stat. 38, 2010 (multiplicity by prior odds).
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
    std::optional<std::size_t> which;  ///< index of the group or unit; none of a part that no group is
    std::vector<std::size_t> units;    ///< whose it is
    Level size;                        ///< m, given the other deviations, floors
    double log_odds = 0.0;             ///< natural log odds against its absence, beside the other deviations
    double probability = 0.0;          ///< probability among this set, none, and all other sets
    /// Natural logarithms of the likelihood ratios of the best set of each kind in its place, against none.
    double log_all = 0.0, log_group = 0.0, log_unit = 0.0;
};

/// An explanation of all units' levels.
struct Attribution {
    std::vector<Share> shares;   ///< in the order in which they were found
    double spread = 0.0;         ///< tau, most probable value, floors: the units' other differences
    std::vector<double> levels;  ///< of each unit: its value, or the mean of what it may be; floors
};

/// @param levels  of all units, with limits where they are not named; three at least, fewer cannot be told
/// apart, and have no shares
/// @param groups  sets of units that may share a cause, each of two units at least, none of all
/// @param quantities  that are looked at, Q
Attribution attribute(std::span<const Level> levels, std::span<const std::vector<std::size_t>> groups,
                      double quantities);

}  // namespace fidservo::fleet
