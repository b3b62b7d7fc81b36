// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Units as draws from a population: partial pooling.
//
//     y_u = theta_u + e_u,   e_u ~ N(0, s_u^2),   theta_u ~ N(mu, tau^2)
//
// tau^2 maximises the restricted likelihood, w = 1 / (s^2 + tau^2),
//
//     log L = -1/2 [ sum log(1/w_u) + log sum w_u + sum w_u (y_u - mu)^2 ],   mu = sum w y / sum w
//
// and a unit's value given the fleet is drawn to the fleet's mean by how little it says itself:
//
//     theta_u | y = B y_u + (1 - B) mu,   B = tau^2 / (tau^2 + s_u^2),   var = B s_u^2 + (1 - B)^2 var(mu)
//
// Sources: Efron, Morris, JASA 70, 1975; Raudenbush, Bryk, Hierarchical Linear Models, 2002, ch. 3.
#include "src/fleet/report/statistics/point.h"

#include <span>

namespace fidservo::fleet {

/// What units are draws from.
struct Population {
    double mean = 0.0, mean_std = 0.0;  ///< mu and its standard error
    double spread = 0.0;                ///< tau, from unit to unit
};

/// Of one unit at least. Of a single one the spread is 0.
Population population_of(std::span<const Level> units);

/// A unit's value, given the fleet.
Level pooled(const Level& unit, const Population& population);

}  // namespace fidservo::fleet
