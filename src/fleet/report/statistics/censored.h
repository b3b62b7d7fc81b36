// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Likelihoods of censored values: some are known only to be below a limit (Tobit model).
//
//     named:      N(y; theta, v)
//     not named:  P(|theta + e| < L) = Phi((L - theta)/sqrt(v)) - Phi((-L - theta)/sqrt(v)),   e ~ N(0, v)
//
// A diagnosis names no effect that is smaller than its limit L, so that the named values are a selection:
// counting the others as zeros, or leaving them out, would bias level and scatter. Both factors are
// log-concave in theta, with a curvature of at most 1/v, so that their product is nowhere narrower than a
// normal density of variance 1 / sum(1/v), which sets the step of the integration (nodes.h). Sources: Tobin,
// Econometrica 26, 1958; Amemiya, J. Econometrics 24, 1984.
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

/// The likelihood of points as a function of their level and of the size of a change that adds `size *
/// column` to each point. The factors of all named points are combined to a quadratic; those of points with
/// identical limits to one factor with an exponent.
class LevelLikelihood {
  public:
    void add(const Point& point, double variance, double column = 0.0);

    /// Natural logarithm.
    double log_at(double level, double size = 0.0) const;
    /// An approximate level, with points that are not named taken as 0, and a lower bound of its standard
    /// deviation.
    Level rough_level() const { return {product_ / weights_, 1.0 / std::sqrt(weights_)}; }
    /// rough_level() for the size of the change, at a given level.
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

/// The likelihood of the points' common level, at nodes of the level.
/// @param extra_variance  added to the square of each std, floors^2
/// @param times  factor on their variances
Nodes over_level(std::span<const Point> points, double extra_variance, double times = 1.0);

/// The level as a normal distribution. A level that is not named is taken to be uniform between -L and L, its
/// limit: mean 0, variance L^2/3 + s^2, with s the standard error.
Level as_normal(const Level& level);

/// as_normal() of a point.
Point as_normal(const Point& point);

}  // namespace fidservo::fleet
