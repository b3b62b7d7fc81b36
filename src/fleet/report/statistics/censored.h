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

#include <cmath>
#include <span>
#include <vector>

namespace fidservo::fleet {

/// log P(|x| < limit) for x ~ N(mean, std^2).
double log_within(double limit, double mean, double std);

/// Mean and variance of x ~ N(mean, std^2) given |x| < limit.
Moments moments_within(double limit, double mean, double std);

/// The likelihood of points by their level, and by the size of a change that adds `size * column` to each.
/// Values of named points combine to a quadratic; identical limits of points that are not named are one
/// factor with an exponent.
class LevelLikelihood {
  public:
    void add(const Point& point, double variance, double column = 0.0);

    /// Natural logarithm.
    double log_at(double level, double size = 0.0) const;
    /// An approximate level, with points that are not named taken as 0, and a lower bound of its standard
    /// deviation.
    Level rough_level() const { return {product_ / weights_, 1.0 / std::sqrt(weights_)}; }
    /// The same for the size of the change, given the level.
    Level rough_size(double level) const;
    bool all_named() const { return unseen_.empty(); }

  private:
    struct Unseen {
        double limit, std, column, count;
    };
    double weights_ = 0.0, product_ = 0.0, column_weights_ = 0.0, column_squares_ = 0.0,
           column_product_ = 0.0;
    /// Sums over the named points: weights, weighted values and squares, and logarithms of their factors.
    double named_ = 0.0, named_product_ = 0.0, named_column_ = 0.0, named_column_square_ = 0.0,
           named_column_product_ = 0.0, named_square_ = 0.0, log_factors_ = 0.0;
    std::vector<Unseen> unseen_;
};

/// The likelihood of the level that points share, over the level.
/// @param extra_variance  added to the square of each std, floors^2
/// @param times  factor on their variances
Nodes over_level(std::span<const Point> points, double extra_variance, double times = 1.0);

/// The level as a normal distribution: one that is not named is uniform up to its limit L, with the variance
/// L^2/3 plus s^2 of its error.
Level as_normal(const Level& level);

/// The same for a point.
Point as_normal(const Point& point);

}  // namespace fidservo::fleet
