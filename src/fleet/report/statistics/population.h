// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Units as draws from a population: partial pooling.
//
//     y_u = theta_u + e_u,   e_u ~ N(0, s_u^2),   theta_u ~ N(mu, tau^2)
//
// For a unit without a diagnosis that names the quantity, only |y_u| < L_u is known (censored.h). tau
// maximises the likelihood with mu integrated out, which is the restricted likelihood if all units are named;
// mu and its standard error are mean and standard deviation of the likelihood of mu at this tau:
//
//     L(tau) = integral over mu of the product over u of  N(y_u; mu, s_u^2 + tau^2)  or
//              Phi((L_u - mu) / sqrt(s_u^2 + tau^2)) - Phi((-L_u - mu) / sqrt(s_u^2 + tau^2))
//
// A unit's value given the fleet is shrunk towards the fleet's mean, the more the less precise its own value
// y is. For a unit that is not named, y and V are mean and variance of the values that are possible below its
// limit; otherwise V = 0:
//
//     theta_u | y = B y_u + (1 - B) mu,   B = tau^2 / (tau^2 + s_u^2),
//     var = B s_u^2 + B^2 V + (1 - B)^2 var(mu)
//
// Sources: Efron, Morris, JASA 70, 1975; Raudenbush, Bryk, Hierarchical Linear Models, 2002, ch. 3; Tobin,
// Econometrica 26, 1958.
#include "src/fleet/report/statistics/point.h"

#include <span>

namespace fidservo::fleet {

/// The population from which units are drawn.
struct Population {
    double mean = 0.0, mean_std = 0.0;  ///< mu and its standard error
    double spread = 0.0;                ///< tau, the standard deviation between units
};

/// Requires at least one unit; for a single unit the spread is 0.
Population population_of(std::span<const Level> units);

/// A unit's value given the fleet; also for a unit that is not named.
Level pooled(const Level& unit, const Population& population);

}  // namespace fidservo::fleet
