// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Likelihoods of values of which some are known only to be too small to be seen (Tobit).
//
//     named:      N(y; theta, v)
//     not named:  P(|theta + e| < L) = Phi((L - theta)/sqrt(v)) - Phi((-L - theta)/sqrt(v)),   e ~ N(0, v)
//
// A diagnosis names nothing that is smaller than its limit L, so that what is named is a selection: to count
// the others as zeros, or not at all, draws levels and scatter to the wrong place. Both factors are
// log-concave in theta, with a curvature of 1/v at most, so that their product is nowhere narrower than a
// normal law of the variance 1 / sum(1/v): nodes.h. Sources: Tobin, Econometrica 26, 1958; Amemiya,
// J. Econometrics 24, 1984.
#include "src/fleet/report/statistics/nodes.h"
#include "src/fleet/report/statistics/point.h"

#include <span>

namespace fidservo::fleet {

/// log P(|x| < limit) of x ~ N(mean, std^2).
double log_within(double limit, double mean, double std);

/// Mean and variance of x ~ N(mean, std^2) where |x| < limit.
Moments moments_within(double limit, double mean, double std);

/// log p(what a diagnosis says | theta), natural.
/// @param variance  v: of its error and of all scatter, floors^2
double log_likelihood(const Point& point, double theta, double variance);

/// The likelihood of the level that points share, over the level.
/// @param extra_variance  that each has beside the square of its std, floors^2
/// @param times  that their variances count
Nodes over_level(std::span<const Point> points, double extra_variance, double times = 1.0);

/// As a normal law: one that is not named allows all values up to its limit alike, with the variance L^2/3,
/// and s^2 of its error.
Level as_normal(const Level& level);

/// Likewise.
Point as_normal(const Point& point);

}  // namespace fidservo::fleet
